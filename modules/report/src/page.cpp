#include "drape/report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "drape/report/readable_number.hpp"
#include "html_text.hpp"
#include "page_parts.hpp"
#include "page_script.hpp"

namespace drape::report {
namespace {

std::string_view word(RunStatus status) {
  return status == RunStatus::ok ? "OK" : status == RunStatus::review ? "Needs review" : "Failed";
}

// "2026-05-14T10:11:12Z" as "2026-05-14 10:11:12 UTC"; what is no such time as it is.
std::string time_element(const std::string& iso) {
  if (iso.size() < 19 || iso[10] != 'T') return escaped(iso);
  std::string shown = iso;
  shown[10] = ' ';
  if (shown.ends_with('Z')) shown.replace(shown.size() - 1, 1, " UTC");
  return fmt::format("<time datetime=\"{}\">{}</time>", escaped(iso), escaped(shown));
}

std::string title_of(const RunPage& page) {
  return page.title.empty() ? "Run without a name" : escaped(page.title);
}

std::string navigation(const RunPage& page) {
  std::string text =
      "<nav aria-label=\"Contents\">\n<div class=\"brand\">drape<small>run report</small></div>\n<ul><li><a "
      "href=\"#result\">Result</a></li>";
  if (!page.stages.empty()) text += "<li><a href=\"#times\">Times</a></li>";
  text += "</ul>\n";
  if (!page.stages.empty()) {
    text += "<ul class=\"group\">\n";
    for (std::size_t i = 0; i < page.stages.size(); ++i) {
      const StageSection& stage = page.stages[i];
      const std::string flag =
          stage.warnings.empty()
              ? ""
              : fmt::format(
                    "<span class=\"flag\" title=\"{0} warning{1}\" role=\"img\" aria-label=\"{0} "
                    "warning{1}\">!</span>",
                    stage.warnings.size(), stage.warnings.size() == 1 ? "" : "s");
      text += fmt::format(
          "<li><a href=\"#stage-{}\"><span class=\"dot {}\" aria-hidden=\"true\"></span><span "
          "class=\"name\">{}</span>{}</a></li>\n",
          i + 1, status_class(stage.status), escaped(stage.name), flag);
    }
    text += "</ul>\n";
  }
  return text + "<ul><li><a href=\"#provenance\">Provenance</a></li></ul>\n</nav>\n";
}

std::string facts(const RunPage& page) {
  const auto reused = std::count_if(page.stages.begin(), page.stages.end(), [](const StageSection& stage) {
    return stage.status == StageStatus::reused;
  });
  std::string text;
  if (!page.started.empty()) text += "started " + time_element(page.started) + " \u00b7 ";
  text += "took " + readable_seconds(page.seconds);
  if (!page.stages.empty())
    text += fmt::format(" \u00b7 {} stage{}, {} reused", page.stages.size(),
                        page.stages.size() == 1 ? "" : "s", reused);
  return text;
}

// The model in three dimensions, which the script fills in, and what it needs.
std::string model_view(const ModelView& view) {
  const std::string data =
      "<script type=\"application/json\" id=\"page-data\">" + json_in_script(view.data_json) + "</script>\n";
  if (view.glb_bytes.empty()) return data;
  return "<div id=\"view\" class=\"view\"><noscript><p class=\"note\">Without scripts the model cannot be "
         "turned; the pictures show it from all sides.</p></noscript></div>\n" +
         data + "<script type=\"application/octet-stream\" id=\"model-bytes\">" + base64(view.glb_bytes) +
         "</script>\n";
}

// The title, how the run ended, and what came of it.
std::string result(const RunPage& page) {
  return fmt::format(
             "<section class=\"card\" id=\"result\">\n<p class=\"eyebrow\">Run report</p>\n<div "
             "class=\"titleline\"><h1>{}</h1>{}</div>\n<p class=\"meta\">{}</p>\n",
             title_of(page), status_pill(page.status), facts(page)) +
         note(page.status == RunStatus::failed ? "Why it failed" : "Why it needs review", page.reasons,
              page.status == RunStatus::failed) +
         number_tiles(page.numbers) + (page.view ? model_view(*page.view) : "") +
         picture_grid(page.pictures, "result", true) + "</section>\n";
}

std::string times(const RunPage& page) {
  return "<section class=\"card\" id=\"times\">\n<h2>Times and memory</h2>\n" + time_table(page) +
         "<p class=\"meta\">Memory is the most that a stage held at one time. Of a reused stage: what it "
         "took in the run that made it.</p>\n</section>\n";
}

std::string stage_section(const StageSection& stage, std::size_t index) {
  std::string cost = readable_seconds(stage.seconds);
  if (stage.peak_memory_mb > 0) cost += " \u00b7 " + readable_memory(stage.peak_memory_mb);
  std::string text = fmt::format(
      "<section class=\"card\" id=\"stage-{0}\">\n<div "
      "class=\"head\"><h2>{0}\u2002{1}</h2>{2}<span class=\"cost\">{3}</span></div>\n",
      index, escaped(stage.name), status_pill(stage.status), cost);
  if (!stage.summary.empty()) text += "<p class=\"summary\">" + escaped(stage.summary) + "</p>\n";
  text += note(stage.warnings.size() == 1 ? "Warning" : "Warnings", stage.warnings, false);
  text += number_table(stage.numbers);
  if (!stage.pictures.empty())
    text += "<h3>Pictures</h3>\n" + picture_grid(stage.pictures, fmt::format("picture-{}", index), false);
  return text + option_table(stage.options) + "</section>\n";
}

std::string provenance(const RunPage& page) {
  std::string text = "<section class=\"card\" id=\"provenance\">\n<h2>Provenance</h2>\n";
  if (!page.command_line.empty())
    text += fmt::format("<h3>Make it again</h3>\n<pre class=\"wrap\"><code>{}</code></pre>\n",
                        escaped(page.command_line));
  if (!page.versions.empty()) {
    text += "<h3>Versions</h3>\n<table class=\"options\"><tbody>\n";
    for (const auto& [what, which] : page.versions)
      text += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escaped(what), escaped(which));
    text += "</tbody></table>\n";
  }
  if (!page.config_text.empty())
    text += fmt::format(
        "<h3>Configuration</h3>\n<details open=\"open\"><summary>The whole "
        "file</summary><pre><code>{}</code></pre></details>\n",
        escaped(page.config_text));
  return text + "</section>\n";
}

}  // namespace

std::string render_page(const RunPage& page) {
  const ScriptElement script = page.view ? script_element(run_page_script()) : ScriptElement();
  const std::string name = page.title.empty() ? "Run without a name" : page.title;
  std::string text = page_head(name + " \u00b7 " + std::string(word(page.status)), "", script.policy_source);
  text += "<body>\n<a class=\"skip\" href=\"#result\">Skip to the result</a>\n<div class=\"frame\">\n";
  text += navigation(page) + "<main>\n" + result(page);
  // The script fills it in where there is something to put right.
  if (page.view) text += "<section class=\"card\" id=\"mend\" hidden=\"hidden\"></section>\n";
  if (!page.stages.empty()) text += times(page);
  for (std::size_t i = 0; i < page.stages.size(); ++i) text += stage_section(page.stages[i], i + 1);
  text += provenance(page);
  text += "<footer>Made by drape. Everything on this page is in this one file.</footer>\n";
  return text + "</main>\n</div>\n" + script.html + "</body>\n</html>\n";
}

}  // namespace drape::report
