#include "drape/report/batch_page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "drape/report/readable_number.hpp"
#include "encoded_picture.hpp"
#include "html_text.hpp"
#include "page_parts.hpp"
#include "page_script.hpp"
#include "page_style.hpp"

namespace drape::report {
namespace {

constexpr std::string_view batch_style = R"css(
.frame.wide { grid-template-columns: minmax(0, 1fr); }
.counts { display: flex; flex-wrap: wrap; gap: .6rem; margin-top: 1rem; }
#filters { display: flex; flex-wrap: wrap; gap: .7rem; align-items: center; margin-top: 1.1rem; }
input[type=search] { font: inherit; font-size: .9rem; padding: .35rem .8rem; border: 1px solid var(--line); border-radius: 9px; background: var(--card); color: var(--ink); }
#objects { margin-top: 1rem; }
#objects td, #objects tbody th { vertical-align: middle; }
#objects .message { color: var(--soft); overflow-wrap: anywhere; min-width: 14rem; }
#objects img { display: block; width: 7rem; height: auto; border-radius: 6px; }
#objects .mended th::after { content: " \270E fix"; color: var(--accent); font-weight: 650; font-size: .85rem; }
#fixes { margin-top: .9rem; }
#fixes .meta { margin: .9rem 0 .5rem; }
.sort { border: 0; background: none; padding: 0; font-weight: 600; color: var(--soft); font-size: .83rem; }
[aria-sort=ascending] .sort::after { content: " \25B2"; }
[aria-sort=descending] .sort::after { content: " \25BC"; }
@media (max-width: 36rem) {
  #objects thead { display: none; }
  #objects tr { display: grid; grid-template-columns: 9.5rem minmax(0, 1fr); gap: .2rem .8rem; padding: .8rem 0; border-bottom: 1px solid var(--line); }
  #objects tr[hidden] { display: none; }
  #objects td, #objects th { border: 0; padding: 0; text-align: left; }
  #objects .message, #objects .shown { grid-column: 1 / -1; min-width: 0; }
}
)css";

std::string pill_of(const std::string& status) {
  if (status == "ok") return status_pill(RunStatus::ok);
  if (status == "review") return status_pill(RunStatus::review);
  if (status == "failed") return status_pill(RunStatus::failed);
  return "<span class=\"pill reused\">" + escaped(status) + "</span>";
}

std::string thumbnail(const BatchRow& row) {
  const auto picture = encoded_picture(row.png_or_jpeg_bytes);
  if (!picture) return {};
  return fmt::format(
      R"(<img src="data:{};base64,{}" width="{}" height="{}" loading="lazy" alt="Overlay of {}" />)",
      picture->media_type, base64(row.png_or_jpeg_bytes), picture->width, picture->height,
      escaped(row.object));
}

std::string row_of(const BatchRow& row) {
  // The object's page sends what is put right there back to this one.
  const std::string name = row.link.empty()
                               ? escaped(row.object)
                               : fmt::format(R"(<a href="{}" target="_blank" rel="opener">{}</a>)",
                                             escaped(row.link), escaped(row.object));
  std::string why = escaped(row.message);
  if (!row.stage.empty()) why = "<b>" + escaped(row.stage) + "</b>: " + why;
  return fmt::format(
      "<tr data-object=\"{0}\" data-status=\"{1}\"><td>{2}</td><th scope=\"row\">{3}</th><td "
      "class=\"shown\">{4}</td><td "
      "class=\"message\">{5}</td><td class=\"figure\" data-value=\"{6}\">{7}</td><td class=\"figure\" "
      "data-value=\"{8}\">{9}</td><td>{10}</td></tr>\n",
      escaped(row.object), escaped(row.status), pill_of(row.status), name, thumbnail(row), why, row.seconds,
      row.seconds > 0 ? readable_seconds(row.seconds) : "", row.peak_memory_mb,
      row.peak_memory_mb > 0 ? readable_memory(row.peak_memory_mb) : "", escaped(row.ran));
}

std::string counts(const BatchPage& page) {
  std::string text = "<p class=\"counts\">";
  for (const char* status : {"failed", "missing", "review", "ok"}) {
    const auto count = std::count_if(page.rows.begin(), page.rows.end(),
                                     [&](const BatchRow& row) { return row.status == status; });
    if (count > 0) text += fmt::format("<span>{} <b>{}</b></span>", pill_of(status), count);
  }
  return text + "</p>\n";
}

}  // namespace

std::string render_batch(const BatchPage& page) {
  const ScriptElement script = script_element(batch_page_script());
  std::string text = page_head(page.title, batch_style, script.policy_source);
  text +=
      "<body>\n<div class=\"frame wide\">\n<main>\n<section class=\"card\">\n<p "
      "class=\"eyebrow\">Batch</p>\n<h1>" +
      escaped(page.title) + "</h1>\n<p class=\"meta\">" + escaped(page.facts) + "</p>\n" + counts(page) +
      "<div id=\"filters\"></div>\n<div class=\"scroll\"><table id=\"objects\"><thead><tr>";
  for (const char* column : {"Status", "Object", "Overlay", "Why", "Time", "Memory", "Stages made"})
    text += fmt::format("<th scope=\"col\">{}</th>", column);
  text += "</tr></thead><tbody>\n";
  for (const BatchRow& row : page.rows) text += row_of(row);
  text +=
      "</tbody></table></div>\n</section>\n<section class=\"card\" id=\"fixes-card\" hidden=\"hidden\">\n"
      "<h2>Put right</h2>\n<p class=\"summary\">Open an object\u2019s page from this one; what you put right "
      "there is "
      "collected here, for all objects in one file.</p>\n<div id=\"fixes\"><p class=\"meta\">Then, in the "
      "folder that "
      "it was downloaded to:</p>\n<pre class=\"wrap\"><code>" +
      escaped(page.apply_command) + "</code></pre></div>\n</section>\n";
  return text + "<footer>Made by drape.</footer>\n</main>\n</div>\n" + script.html + "</body>\n</html>\n";
}

}  // namespace drape::report
