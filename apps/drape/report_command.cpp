#include <fmt/core.h>

#include "commands.hpp"
#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/pipeline/batch_plan.hpp"
#include "drape/pipeline/fixes.hpp"
#include "drape/pipeline/manifest.hpp"
#include "drape/pipeline/sweep.hpp"
#include "drape/stages/batch_report.hpp"
#include "drape/stages/comparison_report.hpp"
#include "drape/stages/run_report.hpp"
#include "drape/stages/stage_table.hpp"
#include "run_selection.hpp"

namespace drape::app {
namespace fs = std::filesystem;
namespace {

// The configuration that the run was made from, whatever its file says by now.
pipeline::Config config_of(const SelectedRun& run, std::span<const pipeline::Stage> table) {
  const pipeline::RunRecord& record = run.record;
  pipeline::ConfigNode root = pipeline::parse_yaml(record.config_text, record.config_file);
  for (const std::string& set : record.sets) pipeline::set_value(root, set);
  if (const fs::path fixes = run.workspace.run_folder(record.name) / "fixes.yaml"; fs::exists(fixes))
    for (const pipeline::ObjectFixes& one : pipeline::read_fixes(fixes)) pipeline::apply_fixes(root, one);
  pipeline::Config config =
      pipeline::configure({record.name, record.config_file, record.config_text, root}, table, record.sets);
  config.workspace = run.workspace.folder();
  return config;
}

fs::path report_of_run(const SelectedRun& run) {
  const auto table = stages::stage_table();
  pipeline::Config config = config_of(run, table);
  pipeline::RunResult result;
  result.record = run.record;
  result.folder = run.workspace.run_folder(run.record.name);
  result.anything_ran = true;
  std::vector<pipeline::ConfiguredStage> configured;
  for (const pipeline::RunStage& stage : run.record.stages) {
    const auto record = run.workspace.find(stage.stage, stage.key);
    if (!record)
      throw input_error("run {}: the result of {} is no longer there; drape run makes it again",
                        run.record.name, stage.stage);
    result.stages.push_back(*record);
    for (const pipeline::ConfiguredStage& one : config.stages)
      if (one.stage->name == stage.stage) configured.push_back(one);
  }
  if (configured.size() != result.stages.size())
    throw input_error("run {}: has other stages than its configuration; drape run makes it again",
                      run.record.name);
  config.stages = std::move(configured);
  return stages::write_run_report(config, result, versions());
}

fs::path report_of_batch(const pipeline::BatchPlan& plan) {
  return stages::write_batch_report(plan.batch, pipeline::summarize(plan.batch));
}

}  // namespace

void report_command(const ReportArguments& arguments) {
  const fs::path what = arguments.what;
  fs::path page;
  if (pipeline::is_plan(what)) {
    page = report_of_batch(pipeline::read_plan(what));
  } else if (fs::is_regular_file(what) && extension(what) == "csv") {
    page = report_of_batch(pipeline::read_plan(pipeline::read_manifest(what).folder()));
  } else {
    const pipeline::ConfigNode root = fs::is_regular_file(what) && extension(what) != "html"
                                          ? pipeline::parse_yaml(read_file(what), what.string())
                                          : pipeline::ConfigNode();
    if (root.kind == pipeline::ConfigNode::Kind::map && root.find("sweep") != nullptr) {
      pipeline::Sweep sweep = pipeline::read_sweep(what, {});
      // The digests of its points tell whether their results are of the present configuration.
      pipeline::plan_batch(sweep.batch, stages::stage_table(), false);
      page = stages::write_sweep_report(sweep, pipeline::sweep_table(sweep));
    } else if (root.kind == pipeline::ConfigNode::Kind::map && root.find("objects") != nullptr) {
      page = report_of_batch(pipeline::read_plan(pipeline::read_manifest(what).folder()));
    } else {
      page = report_of_run(select_run(arguments.what, arguments.workspace));
    }
  }
  fmt::print("report   {}\n", page.string());
}

}  // namespace drape::app
