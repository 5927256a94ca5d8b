#include "page_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "drape/report/readable_number.hpp"
#include "encoded_picture.hpp"
#include "html_text.hpp"
#include "page_style.hpp"

namespace drape::report {
namespace {

std::string pill(std::string_view kind, std::string_view sign, std::string_view word) {
  return fmt::format(R"(<span class="pill {}"><span aria-hidden="true">{}</span>{}</span>)", kind, sign,
                     word);
}

// A value that is told in words wraps; figures never do.
bool is_words(const Number& number) {
  return number.value_text.find(' ') != std::string::npos && number.unit.empty() &&
         std::any_of(number.value_text.begin(), number.value_text.end(),
                     [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); });
}

std::string value_with_unit(const Number& number) {
  std::string text = escaped(number.value_text);
  if (!number.unit.empty())
    text += fmt::format(R"(<span class="unit">&#160;{}</span>)", escaped(number.unit));
  return text;
}

std::string caption_of(const Picture& picture) {
  std::string text = "<b>" + escaped(picture.title) + "</b>";
  if (!picture.caption.empty()) text += (picture.title.empty() ? "" : "<br />") + escaped(picture.caption);
  return text;
}

// Rows of views take the whole width of the page, large sheets of them two places of the grid.
std::string_view slot_size(const EncodedPicture& picture) {
  if (picture.width > 2 * picture.height) return " wide";
  return picture.width >= 1000 && picture.width > picture.height ? " double" : "";
}

std::string figure(const Picture& picture, const std::string& id) {
  const auto encoded = encoded_picture(picture.png_or_jpeg_bytes);
  if (!encoded)
    return fmt::format(
        "<div class=\"slot\"><figure><div class=\"plate broken\">This picture is missing: its bytes are "
        "neither PNG "
        "nor JPEG.</div><figcaption>{}</figcaption></figure></div>\n",
        caption_of(picture));
  // The link makes the figure the page's target, which the style shows alone and large; the second leads
  // back.
  return fmt::format(
      "<div class=\"slot{0}\" id=\"{1}-back\"><figure id=\"{1}\"><a class=\"plate\" href=\"#{1}\" "
      "title=\"Show larger\"><img src=\"data:{2};base64,{3}\" width=\"{4}\" height=\"{5}\" alt=\"{6}\"{8} "
      "/></a><figcaption>{7}</figcaption><a class=\"close\" href=\"#{1}-back\">Close</a></figure></div>\n",
      slot_size(*encoded), id, encoded->media_type, base64(picture.png_or_jpeg_bytes), encoded->width,
      encoded->height, escaped(picture.alt_text.empty() ? picture.title : picture.alt_text),
      caption_of(picture), picture.key.empty() ? "" : fmt::format(" data-key=\"{}\"", escaped(picture.key)));
}

std::string time_row(const StageSection& stage, std::size_t index, double longest) {
  const double share = longest > 0 ? 100 * std::clamp(stage.seconds / longest, 0.0, 1.0) : 0.0;
  return fmt::format(
      "<tr><th scope=\"row\"><a href=\"#stage-{}\">{}</a></th><td>{}</td><td class=\"figure\">{}</td><td "
      "class=\"figure\">{}</td><td class=\"share\"><span class=\"track\"><span class=\"{}\" "
      "style=\"width:{:.1f}%\"></span></span></td></tr>\n",
      index, escaped(stage.name), status_pill(stage.status), readable_seconds(stage.seconds),
      stage.peak_memory_mb > 0 ? readable_memory(stage.peak_memory_mb) : "\u2013", status_class(stage.status),
      share);
}

}  // namespace

std::string page_head(std::string_view title, std::string_view style, const std::string& script_source) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\" />\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\" />\n"
      "<meta name=\"color-scheme\" content=\"light dark\" />\n"
      // The browser itself then refuses whatever is not in this file.
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data: blob:; "
      "style-src 'unsafe-inline'{}\" />\n<title>{}</title>\n<style>{}{}</style>\n</head>\n",
      script_source.empty() ? std::string() : "; connect-src blob:; script-src " + script_source,
      escaped(title), page_style(), style);
}

std::string_view status_class(RunStatus status) {
  return status == RunStatus::ok ? "ok" : status == RunStatus::review ? "review" : "failed";
}

std::string_view status_class(StageStatus status) {
  return status == StageStatus::ran ? "ran" : status == StageStatus::reused ? "reused" : "failed";
}

std::string status_pill(RunStatus status) {
  if (status == RunStatus::ok) return pill("ok", "\u2713", "OK");
  if (status == RunStatus::review) return pill("review", "!", "Needs review");
  return pill("failed", "\u2715", "Failed");
}

std::string status_pill(StageStatus status) {
  if (status == StageStatus::ran) return pill("ran", "\u25b8", "ran");
  if (status == StageStatus::reused) return pill("reused", "\u21ba", "reused");
  return pill("failed", "\u2715", "failed");
}

std::string note(std::string_view heading, const std::vector<std::string>& lines, bool failed) {
  if (lines.empty()) return {};
  std::string text =
      fmt::format("<div class=\"note{}\"><strong>{}</strong><ul>", failed ? " failed" : "", escaped(heading));
  for (const std::string& line : lines) text += "<li>" + escaped(line) + "</li>";
  return text + "</ul></div>\n";
}

std::string number_tiles(const std::vector<Number>& numbers) {
  if (numbers.empty()) return {};
  std::string text = "<dl class=\"tiles\">\n";
  for (const Number& number : numbers)
    text += fmt::format(
        "<div><dt>{}</dt><dd class=\"value\">{}</dd>{}</div>\n", escaped(number.name),
        value_with_unit(number),
        number.meaning.empty() ? "" : "<dd class=\"meaning\">" + escaped(number.meaning) + "</dd>");
  return text + "</dl>\n";
}

std::string number_table(const std::vector<Number>& numbers) {
  if (numbers.empty()) return {};
  const bool bare =
      std::all_of(numbers.begin(), numbers.end(), [](const Number& n) { return n.meaning.empty(); });
  std::string text = fmt::format(
      "<h3>Numbers</h3>\n<table class=\"numbers{}\"><thead><tr><th scope=\"col\">What</th><th "
      "scope=\"col\" class=\"figure\">Value</th>{}</tr></thead><tbody>\n",
      bare ? " bare" : "", bare ? "" : "<th scope=\"col\" class=\"meaning\">Meaning</th>");
  for (const Number& number : numbers)
    text += fmt::format("<tr><th scope=\"row\">{}</th><td class=\"{}\">{}</td>{}</tr>\n",
                        escaped(number.name), is_words(number) ? "words" : "figure", value_with_unit(number),
                        bare ? "" : "<td class=\"meaning\">" + escaped(number.meaning) + "</td>");
  return text + "</tbody></table>\n";
}

std::string picture_grid(const std::vector<Picture>& pictures, std::string_view id, bool large) {
  if (pictures.empty()) return {};
  std::string text = fmt::format("<div class=\"pictures{}\">\n", large ? " large" : "");
  for (std::size_t i = 0; i < pictures.size(); ++i)
    text += figure(pictures[i], fmt::format("{}-{}", id, i + 1));
  return text + "</div>\n";
}

std::string option_table(const std::vector<std::pair<std::string, std::string>>& options) {
  if (options.empty()) return {};
  std::string text = "<h3>Changed options</h3>\n<table class=\"options\"><tbody>\n";
  for (const auto& [name, value] : options)
    text += fmt::format("<tr><th scope=\"row\"><code>{}</code></th><td><code>{}</code></td></tr>\n",
                        escaped(name), escaped(value));
  return text + "</tbody></table>\n";
}

std::string time_table(const RunPage& page) {
  double longest = 0;
  double peak_mb = 0;
  for (const StageSection& stage : page.stages) {
    longest = std::max(longest, stage.seconds);
    if (stage.status != StageStatus::reused) peak_mb = std::max(peak_mb, stage.peak_memory_mb);
  }
  std::string text =
      "<div class=\"scroll\"><table class=\"times\"><thead><tr><th scope=\"col\">Stage</th><th "
      "scope=\"col\">State</th><th scope=\"col\" class=\"figure\">Time</th><th scope=\"col\" "
      "class=\"figure\">Memory</th><th scope=\"col\" class=\"share\">Share of the "
      "longest</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < page.stages.size(); ++i) text += time_row(page.stages[i], i + 1, longest);
  text += fmt::format(
      "</tbody><tfoot><tr><th scope=\"row\">This run</th><td></td><td class=\"figure\">{}</td><td "
      "class=\"figure\">{}</td><td class=\"share\"></td></tr></tfoot></table></div>\n",
      readable_seconds(page.seconds), peak_mb > 0 ? readable_memory(peak_mb) : "\u2013");
  return text;
}

}  // namespace drape::report
