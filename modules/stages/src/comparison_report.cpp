#include "drape/stages/comparison_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/numbers.hpp"
#include "drape/io/model_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/report/comparison_page.hpp"
#include "drape/report/contact_sheet.hpp"
#include "drape/report/readable_number.hpp"
#include "drape/report/turntable.hpp"

namespace drape::stages {
namespace fs = std::filesystem;
namespace {

constexpr int picture_side_px = 420;
constexpr std::size_t most_points_with_pictures = 60;
constexpr std::size_t most_plots = 24;

// What can be shown of a stage's result: its pictures, and a render of a textured model. By "stage/file".
std::map<std::string, report::Picture> pictures_of(const ComparedRun& run, bool all) {
  std::map<std::string, report::Picture> pictures;
  const auto add = [&](const std::string& name, const Image8& image) {
    pictures[name] = {name, name, "",
                      io::encode_image(report::fitted(image, picture_side_px, picture_side_px), "jpg", 86)};
  };
  for (const pipeline::RunStage& stage : run.record.stages) {
    const auto record = run.workspace.find(stage.stage, stage.key);
    if (!record) continue;
    const fs::path folder = run.workspace.stage_folder(stage.stage, stage.key);
    for (const pipeline::StageFile& file : record->files) {
      try {
        const bool overlay = fs::path(file.name).filename() == "overlay.png";
        if (extension(file.name) == "png" && (all || overlay) && stage.stage != "export")
          add(stage.stage + "/" + file.name, io::read_photo(folder / file.name).rgb);
        if (stage.stage == "texture" && file.name == "model.ply")
          add("texture/model",
              report::turntable(io::read_textured_ply(folder / file.name, folder / "textures"),
                                {.view = {.views = all ? 4 : 2, .width_px = 320, .height_px = 320}}));
      } catch (const Error&) {
        continue;  // a damaged picture is not worth the page; the next run finds and mends it
      }
    }
  }
  return pictures;
}

std::string shown(const std::string& cell) {
  const auto number = parse_double(cell);
  return number && std::isfinite(*number) ? report::readable_value(*number) : cell;
}

bool takes_several_values(const pipeline::SweepTable& table, std::size_t column) {
  return std::any_of(table.rows.begin(), table.rows.end(),
                     [&](const auto& row) { return row[column] != table.rows.front()[column]; });
}

// What a point cost in this sweep depends on what others had left for it.
bool is_own_cost(const std::string& column) {
  return column == "seconds" || column == "peak_memory_mb";
}

// Columns of numbers that are not all the same: worth a plot.
std::vector<std::size_t> plotted_columns(const pipeline::SweepTable& table) {
  std::vector<std::size_t> columns;
  for (std::size_t c = table.varied + 1; c < table.columns.size(); ++c) {
    const std::string& name = table.columns[c];
    if (name == "status" || name == "error" || is_own_cost(name)) continue;
    std::vector<double> values;
    for (const auto& row : table.rows)
      if (const auto number = parse_double(row[c])) values.push_back(*number);
    if (values.size() < 2) continue;
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    if (*least < *most) columns.push_back(c);
  }
  // What tells quality first: the names that metrics of agreement and error have.
  const auto rank = [&](std::size_t c) {
    const std::string& name = table.columns[c];
    for (const char* word : {"overlap", "error", "seen", "rms"})
      if (name.find(word) != std::string::npos) return 0;
    return name.find("seconds") != std::string::npos ? 1 : 2;
  };
  std::stable_sort(columns.begin(), columns.end(),
                   [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  return columns;
}

std::string point_label(const pipeline::SweepTable& table, const std::vector<std::string>& row) {
  std::string text = row[0];
  for (std::size_t i = 1; i <= table.varied; ++i) text += fmt::format(", {} {}", table.columns[i], row[i]);
  return text;
}

report::Plot against_option(const pipeline::SweepTable& table, std::size_t option, std::size_t metric) {
  report::Plot plot;
  plot.title = table.columns[metric] + " against " + table.columns[option];
  plot.x_label = table.columns[option];
  plot.y_label = table.columns[metric];
  const bool numbers = std::all_of(table.rows.begin(), table.rows.end(),
                                   [&](const auto& row) { return parse_double(row[option]).has_value(); });
  for (const auto& row : table.rows) {
    const auto y = parse_double(row[metric]);
    if (!y) continue;
    double x = 0;
    if (numbers) {
      x = *parse_double(row[option]);
    } else {
      auto name = std::find(plot.x_names.begin(), plot.x_names.end(), row[option]);
      if (name == plot.x_names.end()) name = plot.x_names.insert(name, row[option]);
      x = static_cast<double>(name - plot.x_names.begin());
    }
    plot.points.push_back({x, *y, point_label(table, row)});
  }
  return plot;
}

std::vector<report::Plot> plots_of(const pipeline::SweepTable& table) {
  std::vector<report::Plot> plots;
  const std::vector<std::size_t> metrics = plotted_columns(table);
  const auto time = std::find(table.columns.begin(), table.columns.end(), "align.seconds");
  for (const std::size_t metric : metrics) {
    if (time != table.columns.end() && table.columns[metric].find("overlap") != std::string::npos)
      plots.push_back(against_option(table, static_cast<std::size_t>(time - table.columns.begin()), metric));
    for (std::size_t option = 1; option <= table.varied; ++option)
      if (takes_several_values(table, option)) plots.push_back(against_option(table, option, metric));
    if (plots.size() >= most_plots) break;
  }
  return plots;
}

// "+12.3 (+4.5 %)"; nothing where one of the two has no such number.
std::string change(const std::optional<double>& before, const std::optional<double>& after) {
  if (!before || !after || !std::isfinite(*before) || !std::isfinite(*after)) return {};
  const double difference = *after - *before;
  std::string text = (difference > 0 ? "+" : "") + report::readable_value(difference);
  if (*before != 0) text += fmt::format(" ({:+.3g} %)", 100 * difference / std::abs(*before));
  return text;
}

// What differs between the points, a row each; and what does not, once.
std::pair<report::ComparisonSection, report::ComparisonSection> number_tables(
    const pipeline::SweepTable& table) {
  report::ComparisonSection differ;
  differ.heading = "What differs";
  differ.text =
      "Seconds of a stage are those of making its result, also where a point took it over from another.";
  report::ComparisonSection same;
  same.heading = "The same at every point";
  same.columns = {"what", "value"};
  differ.rows.resize(table.rows.size());
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (c > table.varied && table.columns[c] != "status" && !takes_several_values(table, c)) {
      if (!table.rows.empty() && !table.rows.front()[c].empty())
        same.rows.push_back({table.columns[c], shown(table.rows.front()[c])});
      continue;
    }
    differ.columns.push_back(table.columns[c]);
    for (std::size_t r = 0; r < table.rows.size(); ++r)
      differ.rows[r].push_back(c == 0 ? table.rows[r][c] : shown(table.rows[r][c]));
  }
  if (same.rows.empty()) same.text = "Nothing.";
  return {differ, same};
}

}  // namespace

fs::path write_sweep_report(const pipeline::Sweep& sweep, const pipeline::SweepTable& table) {
  report::ComparisonPage page;
  page.eyebrow = "Experiment";
  page.title = sweep.batch.name;
  page.facts = fmt::format("{} points of {}", table.rows.size(), sweep.batch.source.filename().string());
  const auto [numbers, same] = number_tables(table);
  report::ComparisonSection plots{
      "Plots", "Rest the pointer on a point to see which it is.", {}, {}, plots_of(table), {}, 0};
  report::ComparisonSection sheet{"Pictures", "", {}, {}, {}, {}, 4};
  const pipeline::Workspace workspace(sweep.batch.workspace);
  for (std::size_t i = 0; i < std::min(table.rows.size(), most_points_with_pictures); ++i) {
    const auto record =
        pipeline::read_run_record(workspace.run_folder(sweep.batch.run_name(table.rows[i][0])) / "run.json");
    if (!record) continue;
    for (auto& [name, picture] : pictures_of({workspace, *record}, false)) {
      picture.title = point_label(table, table.rows[i]) + ": " + name;
      sheet.pictures.push_back(std::move(picture));
    }
  }
  page.sections = {numbers};
  if (!plots.plots.empty()) page.sections.push_back(plots);
  if (!sheet.pictures.empty()) page.sections.push_back(sheet);
  page.sections.push_back(same);
  const fs::path file = sweep.batch.folder() / "report.html";
  write_file(file, report::render_comparison(page));
  return file;
}

std::size_t write_run_comparison(const ComparedRun& a, const ComparedRun& b, const fs::path& file) {
  using Parts = std::map<std::string, std::pair<std::string, std::string>>;
  report::ComparisonSection options{
      "What was different", "", {"what", a.record.name, b.record.name}, {}, {}, {}, 0};
  report::ComparisonSection metrics{
      "What came out", "", {"what", a.record.name, b.record.name, "change"}, {}, {}, {}, 0};
  std::vector<std::string> part_order;
  std::vector<std::string> metric_order;
  Parts parts;  // exact values; those of the option table are compared by them and shown readably
  Parts readable;
  Parts values;
  std::map<std::string, std::pair<std::optional<double>, std::optional<double>>> exact;
  const auto note = [](Parts& into, std::vector<std::string>& order, const std::string& name, bool first,
                       const std::string& value) {
    if (into.count(name) == 0) order.push_back(name);
    (first ? into[name].first : into[name].second) = value;
  };
  for (const ComparedRun* run : {&a, &b})
    for (const pipeline::RunStage& stage : run->record.stages) {
      const auto record = run->workspace.find(stage.stage, stage.key);
      if (!record) continue;
      const bool first = run == &a;
      std::vector<std::string> ignored;
      for (const pipeline::KeyPart& part : record->parts) {
        const bool option = part.name.rfind("option.", 0) == 0;
        const std::string name = stage.stage + (option ? "." + part.name.substr(7) : ": " + part.name);
        if (part.name.rfind("file.", 0) == 0) continue;  // follows from what is listed
        note(parts, part_order, name, first, part.value);
        note(readable, ignored, name, first, part.readable);
      }
      const auto number = [&](const std::string& what, double value) {
        note(values, metric_order, stage.stage + "." + what, first, report::readable_value(value));
        (first ? exact[stage.stage + "." + what].first : exact[stage.stage + "." + what].second) = value;
      };
      number("seconds", record->seconds);
      number("peak_memory_mb", record->peak_memory_mb);
      for (const pipeline::Metric& metric : record->metrics)
        if (std::holds_alternative<double>(metric.second))
          number(metric.first, std::get<double>(metric.second));
        else
          note(values, metric_order, stage.stage + "." + metric.first, first,
               std::get<std::string>(metric.second));
    }
  for (const std::string& name : part_order)
    if (parts[name].first != parts[name].second) {
      const auto& [before, after] = readable[name];
      options.rows.push_back({name, before, before == after ? after + " (other contents)" : after});
    }
  metrics.folded_text = "What is the same in both";
  for (const std::string& name : metric_order) {
    const auto& [before, after] = values[name];
    (before == after ? metrics.folded_rows : metrics.rows)
        .push_back(
            {name, before, after, before == after ? "" : change(exact[name].first, exact[name].second)});
  }
  if (metrics.rows.empty()) metrics.text = "No number differs.";
  if (options.rows.empty()) options.text = "Nothing: the same options, files and versions.";

  report::ComparisonSection sheet{
      "Pictures", "Left: " + a.record.name + ". Right: " + b.record.name + ".", {}, {}, {}, {}, 2};
  auto left = pictures_of(a, true);
  auto right = pictures_of(b, true);
  for (const auto& [name, picture] : right) left.try_emplace(name, report::Picture{name, name, "", ""});
  std::string same;
  for (const auto& [name, picture] : left) {
    if (picture.png_or_jpeg_bytes == right[name].png_or_jpeg_bytes) {
      same += (same.empty() ? " The same in both: " : ", ") + name;
      continue;
    }
    sheet.pictures.push_back(picture);
    sheet.pictures.back().title = a.record.name + ": " + name;
    sheet.pictures.push_back(right[name]);
    sheet.pictures.back().title = b.record.name + ": " + name;
  }
  if (!same.empty()) sheet.text += same + ".";
  report::ComparisonPage page{
      "Comparison",
      a.record.name + " and " + b.record.name,
      fmt::format("{}: {}, {}. {}: {}, {}.", a.record.name, a.record.status, a.record.started_at,
                  b.record.name, b.record.status, b.record.started_at),
      {options, metrics, sheet}};
  write_file(file, report::render_comparison(page));
  return options.rows.size();
}

}  // namespace drape::stages
