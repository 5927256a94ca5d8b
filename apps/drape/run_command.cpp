#include <fmt/core.h>

#include "commands.hpp"
#include "drape/base/error.hpp"
#include "drape/pipeline/config.hpp"
#include "drape/pipeline/engine.hpp"
#include "drape/stages/run_report.hpp"
#include "drape/stages/stage_table.hpp"

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
    if (file.extension() == ".glb") fmt::print("model    {}\n", file.string());
  fmt::print("report   {}\n", report.string());
  const std::string overlap = metric_text(result, "align", "overlap_percent");
  if (!overlap.empty()) fmt::print("overlap  {} %\n", overlap);
  fmt::print("time     {:.2f} s\n", result.record.seconds);
  fmt::print("status   {}\n", result.record.status);
  for (const std::string& reason : result.record.reasons) fmt::print("         {}\n", reason);
}

}  // namespace

void run_command(const RunArguments& arguments, const std::atomic<bool>& stop) {
  const auto table = stages::stage_table();
  pipeline::Config config = pipeline::load_config(arguments.config, table, arguments.sets);
  if (arguments.workspace)
    config.workspace = std::filesystem::absolute(*arguments.workspace).lexically_normal();
  pipeline::RunOptions options;
  options.name = arguments.name;
  options.from = arguments.from;
  options.until = arguments.until;
  options.only = arguments.only;
  options.command = arguments.command;
  options.versions = versions();
  options.stop = &stop;
  ProgressDisplay display(arguments.quiet ? ProgressMode::none : arguments.progress);
  const pipeline::RunResult result = pipeline::run(config, options, display);
  const std::filesystem::path report = stages::write_run_report(config, result, versions());
  print_summary(result, report);
}

}  // namespace drape::app
