#include "drape/report/comparison_page.hpp"

#include <fmt/format.h>

#include "html_text.hpp"
#include "page_parts.hpp"

namespace drape::report {
namespace {

constexpr std::string_view comparison_style = R"css(
.frame.wide { grid-template-columns: minmax(0, 1fr); }
.scroll { overflow-x: auto; margin-top: 1rem; }
.compare { border-collapse: collapse; font-size: .875rem; font-variant-numeric: tabular-nums; width: auto; }
.compare th, .compare td { padding: .3rem 1.4rem .3rem 0; border-bottom: 1px solid var(--line); text-align: left; max-width: 22rem; overflow-wrap: break-word; }
.compare th { color: var(--soft); font-weight: 600; }
.compare .figure { text-align: right; white-space: nowrap; }
.compare tbody tr:hover { background: var(--accent-soft); }
details { margin-top: 1rem; }
@media (max-width: 36rem) { .compare th, .compare td { padding-right: .8rem; min-width: 4.5rem; max-width: 12rem; } .compare td:first-child { min-width: 8rem; overflow-wrap: anywhere; } }
.plots { display: grid; grid-template-columns: repeat(auto-fill, minmax(19rem, 1fr)); gap: 1.2rem; margin-top: 1rem; }
.plots svg { width: 100%; height: auto; }
.pairs { display: grid; gap: 1rem; margin-top: 1rem; }
.pairs figure { min-width: 0; }
.pairs img { width: 100%; height: auto; background: var(--plate); border-radius: 8px; }
.pairs figcaption { font-size: .85rem; color: var(--soft); overflow-wrap: anywhere; }
)css";

bool is_figure(const std::string& cell) {
  return !cell.empty() && ((cell[0] >= '0' && cell[0] <= '9') || cell[0] == '-' || cell[0] == '+');
}

// Columns of figures, which stand at the right.
std::vector<bool> figure_columns(const std::vector<std::vector<std::string>>& rows, std::size_t count) {
  std::vector<bool> figures(count, false);
  for (std::size_t c = 1; c < count; ++c) {  // the first names the row
    std::size_t words = 0;
    std::size_t numbers = 0;
    for (const std::vector<std::string>& row : rows) ++(is_figure(row[c]) ? numbers : words);
    figures[c] = numbers > words;
  }
  return figures;
}

std::string table_of(const std::vector<std::string>& columns,
                     const std::vector<std::vector<std::string>>& rows) {
  if (rows.empty()) return {};
  const std::vector<bool> figures = figure_columns(rows, columns.size());
  const auto mark = [&](std::size_t c) { return figures[c] ? " class=\"figure\"" : ""; };
  std::string text = "<div class=\"scroll\" tabindex=\"0\"><table class=\"compare\"><thead><tr>";
  for (std::size_t c = 0; c < columns.size(); ++c)
    text += fmt::format("<th scope=\"col\"{}>{}</th>", mark(c), escaped(columns[c]));
  text += "</tr></thead><tbody>\n";
  for (const std::vector<std::string>& row : rows) {
    text += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c)
      text += fmt::format("<td{}>{}</td>", mark(c), escaped(row[c]));
    text += "</tr>\n";
  }
  return text + "</tbody></table></div>\n";
}

std::string tables_of(const ComparisonSection& section) {
  std::string text = table_of(section.columns, section.rows);
  if (!section.folded_rows.empty())
    text += "<details><summary>" + escaped(section.folded_text) + "</summary>" +
            table_of(section.columns, section.folded_rows) + "</details>\n";
  return text;
}

std::string pictures_of(const ComparisonSection& section, std::size_t index) {
  if (section.pictures.empty()) return {};
  if (section.pictures_in_row == 0)
    return picture_grid(section.pictures, fmt::format("pictures-{}", index), false);
  std::string text =
      fmt::format("<div class=\"pairs\" style=\"grid-template-columns: repeat({}, minmax(0, 1fr))\">\n",
                  section.pictures_in_row);
  for (const Picture& picture : section.pictures) {
    if (picture.png_or_jpeg_bytes.empty()) {
      text += "<p class=\"meta\">" + escaped(picture.title) + ": not there</p>\n";
      continue;
    }
    const bool png = picture.png_or_jpeg_bytes[0] == '\x89';
    text += fmt::format(
        "<figure><img alt=\"{}\" src=\"data:image/{};base64,{}\"/><figcaption>{}</figcaption></figure>\n",
        escaped(picture.alt_text), png ? "png" : "jpeg", base64(picture.png_or_jpeg_bytes),
        escaped(picture.title));
  }
  return text + "</div>\n";
}

}  // namespace

std::string render_comparison(const ComparisonPage& page) {
  std::string text =
      page_head(page.title, comparison_style, "") + "<body>\n<div class=\"frame wide\">\n<main>\n";
  text += fmt::format(
      "<section class=\"card\"><p class=\"eyebrow\">{}</p><h1>{}</h1><p class=\"meta\">{}</p></section>\n",
      escaped(page.eyebrow), escaped(page.title), escaped(page.facts));
  for (std::size_t i = 0; i < page.sections.size(); ++i) {
    const ComparisonSection& section = page.sections[i];
    text += "<section class=\"card\"><h2>" + escaped(section.heading) + "</h2>\n";
    if (!section.text.empty()) text += "<p class=\"meta\">" + escaped(section.text) + "</p>\n";
    text += tables_of(section);
    if (!section.plots.empty()) {
      text += "<div class=\"plots\">\n";
      for (const Plot& plot : section.plots) text += plot_svg(plot);
      text += "</div>\n";
    }
    text += pictures_of(section, i + 1) + "</section>\n";
  }
  return text +
         "<footer>Made by drape. Everything on this page is in this one "
         "file.</footer>\n</main>\n</div>\n</body>\n</html>\n";
}

}  // namespace drape::report
