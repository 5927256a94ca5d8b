#include <fmt/core.h>

#include "commands.hpp"
#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/log.hpp"
#include "drape/pipeline/config.hpp"
#include "drape/pipeline/engine.hpp"
#include "drape/pipeline/fixes.hpp"
#include "drape/pipeline/workspace.hpp"
#include "drape/stages/run_report.hpp"
#include "drape/stages/stage_table.hpp"
#include "forecast.hpp"
#include "run_selection.hpp"

namespace drape::app {
namespace {

// The metric of a stage, as text; empty if there is none.
std::string metric_text(const pipeline::RunResult& result, const std::string& stage,
                        const std::string& name) {
  for (const pipeline::StageRecord& record : result.stages)
    if (record.stage == stage)
      for (const pipeline::Metric& metric : record.metrics)
        if (metric.first == name)
          return std::holds_alternative<double>(metric.second)
                     ? fmt::format("{:.2f}", std::get<double>(metric.second))
                     : std::get<std::string>(metric.second);
  return {};
}

void print_summary(const pipeline::RunResult& result, const std::filesystem::path& report) {
  for (const std::filesystem::path& file : result.published)
    if (file.filename() == "model.glb") fmt::print("model    {}\n", file.string());
  fmt::print("report   {}\n", report.string());
  const std::string overlap = metric_text(result, "align", "overlap_percent");
  if (!overlap.empty()) fmt::print("overlap  {} %\n", overlap);
  fmt::print("time     {:.2f} s\n", result.record.seconds);
  fmt::print("status   {}\n", result.record.status);
  for (const std::string& reason : result.record.reasons) fmt::print("         {}\n", reason);
}

}  // namespace

namespace {

// Fixes that were given once stay with the run: a new photo or scan does not undo them.
std::optional<pipeline::ObjectFixes> fixes_of_run(const RunArguments& arguments,
                                                  const pipeline::Workspace& workspace,
                                                  const std::string& run) {
  const std::filesystem::path kept = workspace.run_folder(run) / "fixes.yaml";
  if (arguments.fixes == "none") {
    std::filesystem::remove(kept);
    return std::nullopt;
  }
  const bool given = !arguments.fixes.empty();
  if (!given && !std::filesystem::exists(kept)) return std::nullopt;
  std::vector<pipeline::ObjectFixes> fixes =
      pipeline::read_fixes(given ? std::filesystem::path(arguments.fixes) : kept);
  std::erase_if(fixes,
                [&](const pipeline::ObjectFixes& one) { return !one.object.empty() && one.object != run; });
  if (fixes.size() != 1)
    throw config_error("{}: has {} entries for run {}; must have one", arguments.fixes, fixes.size(), run);
  fixes[0].object = run;
  if (!given) log::info("with the fixes in {} (--fixes none forgets them)", kept.string());
  return fixes[0];
}

pipeline::Config config_of(const RunArguments& arguments, std::span<const pipeline::Stage> table,
                           std::optional<pipeline::ObjectFixes>& fixes) {
  std::string text = read_file(arguments.config);
  pipeline::ConfigNode root = pipeline::parse_yaml(text, arguments.config.string());
  for (const std::string& set : arguments.sets) pipeline::set_value(root, set);
  const std::filesystem::path workspace =
      arguments.workspace ? std::filesystem::absolute(*arguments.workspace).lexically_normal()
                          : workspace_of(arguments.config);
  const std::string name = arguments.name.empty() ? arguments.config.stem().string() : arguments.name;
  fixes = fixes_of_run(arguments, pipeline::Workspace(workspace), name);
  if (fixes) pipeline::apply_fixes(root, *fixes);
  pipeline::Config config = pipeline::configure(
      {arguments.config.stem().string(), std::filesystem::absolute(arguments.config).lexically_normal(),
       std::move(text), std::move(root)},
      table, arguments.sets);
  if (arguments.workspace) config.workspace = workspace;
  return config;
}

}  // namespace

void run_command(const RunArguments& arguments, const std::atomic<bool>& stop) {
  const auto table = stages::stage_table();
  std::optional<pipeline::ObjectFixes> fixes;
  const pipeline::Config config = config_of(arguments, table, fixes);
  if (arguments.dry_run) {
    print_forecast(pipeline::explain(config, arguments.name), "");
    return;
  }
  pipeline::RunOptions options;
  options.name = arguments.name;
  options.from = arguments.from;
  options.until = arguments.until;
  options.only = arguments.only;
  options.command = arguments.command;
  options.versions = versions();
  options.stop = &stop;
  if (fixes) {
    const std::filesystem::path folder = pipeline::Workspace(config.workspace).run_folder(fixes->object);
    make_folder(folder);
    pipeline::write_fixes(folder / "fixes.yaml", {*fixes});
  }
  ProgressDisplay display(arguments.quiet ? ProgressMode::none : arguments.progress);
  const pipeline::RunResult result = pipeline::run(config, options, display);
  const std::filesystem::path report = stages::write_run_report(config, result, versions());
  print_summary(result, report);
}

}  // namespace drape::app
