#include <fmt/core.h>

#include "commands.hpp"
#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/pipeline/config.hpp"
#include "drape/pipeline/engine.hpp"
#include "drape/pipeline/sweep.hpp"
#include "drape/stages/stage_table.hpp"
#include "forecast.hpp"

namespace drape::app {

void explain_command(const ExplainArguments& arguments) {
  const auto table = stages::stage_table();
  pipeline::Config config = pipeline::load_config(arguments.config, table, arguments.sets);
  if (arguments.workspace)
    config.workspace = std::filesystem::absolute(*arguments.workspace).lexically_normal();
  print_forecast(pipeline::explain(config, arguments.name), arguments.stage);
}

void print_forecast(const std::vector<pipeline::Forecast>& forecasts, const std::string& stage) {
  bool found = stage.empty();
  double seconds = 0;
  bool all_known = true;
  bool any_runs = false;
  for (const pipeline::Forecast& forecast : forecasts) {
    if (!stage.empty() && forecast.stage != stage) continue;
    found = true;
    const bool runs = forecast.state != pipeline::Forecast::State::up_to_date;
    const char* state = !runs                                                    ? "is up to date"
                        : forecast.state == pipeline::Forecast::State::would_run ? "would run"
                                                                                 : "may run";
    std::string cost;
    if (runs) {
      cost = forecast.cost ? fmt::format("about {:.2f} s, {:.0f} MB", forecast.cost->seconds,
                                         forecast.cost->peak_memory_mb)
                           : "never ran here";
      seconds += forecast.cost ? forecast.cost->seconds : 0;
      all_known = all_known && forecast.cost;
      any_runs = true;
    }
    fmt::print("{:<9} {}{}{}\n", forecast.stage, state, cost.empty() ? "" : ", ", cost);
    for (const std::string& reason : forecast.reasons) fmt::print("            {}\n", reason);
  }
  if (!found) throw config_error("{}: no such stage in this run", stage);
  if (any_runs) fmt::print("in all    {}{:.2f} s\n", all_known ? "about " : "at least ", seconds);
}

namespace {

// Of an experiment every point is checked, since only the points need to be whole configurations.
bool is_sweep(const std::filesystem::path& file) {
  return pipeline::parse_yaml(read_file(file), file.string()).find("sweep") != nullptr;
}

}  // namespace

void validate_command(const ValidateArguments& arguments) {
  const auto table = stages::stage_table();
  if (is_sweep(arguments.config)) {
    const pipeline::Sweep sweep = pipeline::read_sweep(arguments.config, arguments.sets);
    for (const pipeline::BatchObject& object : sweep.batch.objects)
      static_cast<void>(pipeline::object_config(sweep.batch, object, table));
    fmt::print("{}: ok\n  points    {}\n  workspace {}\n", arguments.config.string(),
               sweep.batch.objects.size(), sweep.batch.workspace.string());
    return;
  }
  const pipeline::Config config = pipeline::load_config(arguments.config, table, arguments.sets);
  std::string names;
  for (const pipeline::ConfiguredStage& stage : config.stages)
    names += (names.empty() ? "" : ", ") + stage.stage->name;
  fmt::print("{}: ok\n  stages    {}\n  workspace {}\n  output    {}\n", arguments.config.string(), names,
             config.workspace.string(), config.output.string());
}

}  // namespace drape::app
