#include "drape/stages/run_report.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "drape/base/files.hpp"
#include "drape/report/page.hpp"
#include "drape/report/readable_number.hpp"
#include "page_data.hpp"
#include "results.hpp"
#include "stage_pictures.hpp"

namespace drape::stages {
namespace fs = std::filesystem;
namespace {

report::Number to_number(const pipeline::Metric& metric) {
  if (std::holds_alternative<double>(metric.second))
    return report::readable_number(metric.first, std::get<double>(metric.second));
  std::string name = metric.first;
  std::replace(name.begin(), name.end(), '_', ' ');
  return {name, std::get<std::string>(metric.second), "", ""};
}

std::vector<std::pair<std::string, std::string>> changed_options(
    const pipeline::ConfiguredStage& configured) {
  std::vector<std::pair<std::string, std::string>> changed;
  const pipeline::Stage::Instance defaults = configured.stage->instantiate();
  for (std::size_t i = 0; i < defaults.options.size(); ++i) {
    const Option& option = configured.instance.options[i];
    if (canonical(option.get()) != canonical(defaults.options[i].get()))
      changed.emplace_back(option.name, readable(option.get()));
  }
  return changed;
}

report::StageSection section_of(const pipeline::ConfiguredStage& configured,
                                const pipeline::StageRecord& record, const pipeline::RunStage& in_run,
                                const pipeline::Config& config, const pipeline::RunResult& result) {
  report::StageSection section;
  section.name = record.stage;
  section.summary = configured.stage->summary;
  section.status = in_run.ran ? report::StageStatus::ran : report::StageStatus::reused;
  section.seconds = record.seconds;
  section.peak_memory_mb = record.peak_memory_mb;
  for (const pipeline::Metric& metric : record.metrics) section.numbers.push_back(to_number(metric));
  section.pictures = stage_pictures(record.stage, config, result);
  section.warnings = record.warnings;
  section.options = changed_options(configured);
  return section;
}

report::RunPage page_of(const pipeline::Config& config, const pipeline::RunResult& result,
                        const std::vector<std::pair<std::string, std::string>>& versions) {
  report::RunPage page;
  page.title = result.record.name;
  page.status = result.record.status == "ok" ? report::RunStatus::ok : report::RunStatus::review;
  page.reasons = result.record.reasons;
  page.started = result.record.started_at;
  page.seconds = result.record.seconds;
  page.command_line = result.record.command;
  page.config_text = result.record.config_text;
  page.versions = versions;
  for (std::size_t i = 0; i < result.stages.size(); ++i) {
    page.stages.push_back(
        section_of(config.stages[i], result.stages[i], result.record.stages[i], config, result));
    for (const pipeline::Metric& metric : result.stages[i].metrics)
      if (metric.first == "overlap_percent" || metric.first == "seen_percent")
        page.numbers.push_back(to_number(metric));
  }
  page.view = page_view(Results(config, result), result);
  // What a person wants to see first: the textured model, or the mesh where there is no photo, and the
  // overlays.
  const bool textured =
      std::any_of(page.stages.begin(), page.stages.end(),
                  [](const report::StageSection& section) { return section.name == "texture"; });
  const bool one_photo = config.input.photos.size() == 1;
  for (const report::StageSection& section : page.stages) {
    if (section.name == (textured ? "texture" : "fill") && !section.pictures.empty())
      page.pictures.push_back(section.pictures.front());
    for (const report::Picture& picture : section.pictures)
      if (picture.key.starts_with("overlay:") ||
          (one_photo && (picture.key.starts_with("photo:") || picture.key.starts_with("stencil:"))))
        page.pictures.push_back(picture);
  }
  return page;
}

}  // namespace

fs::path write_run_report(const pipeline::Config& config, const pipeline::RunResult& result,
                          const std::vector<std::pair<std::string, std::string>>& versions) {
  fs::path file = result.folder / "report.html";
  if (result.anything_ran || !fs::exists(file))
    write_file(file, report::render_page(page_of(config, result, versions)));
  return file;
}

}  // namespace drape::stages
