#include <fmt/core.h>

#include "commands.hpp"
#include "drape/base/error.hpp"
#include "drape/pipeline/config.hpp"
#include "drape/pipeline/engine.hpp"
#include "drape/stages/stage_table.hpp"

namespace drape::app {

void explain_command(const ExplainArguments& arguments) {
  const auto table = stages::stage_table();
  pipeline::Config config = pipeline::load_config(arguments.config, table, arguments.sets);
  if (arguments.workspace)
    config.workspace = std::filesystem::absolute(*arguments.workspace).lexically_normal();
  bool found = arguments.stage.empty();
  for (const pipeline::Forecast& forecast : pipeline::explain(config, arguments.name)) {
    if (!arguments.stage.empty() && forecast.stage != arguments.stage) continue;
    found = true;
    const char* state = forecast.state == pipeline::Forecast::State::up_to_date  ? "is up to date"
                        : forecast.state == pipeline::Forecast::State::would_run ? "would run"
                                                                                 : "may run";
    fmt::print("{:<9} {}\n", forecast.stage, state);
    for (const std::string& reason : forecast.reasons) fmt::print("            {}\n", reason);
  }
  if (!found) throw config_error("{}: no such stage in this run", arguments.stage);
}

void validate_command(const ValidateArguments& arguments) {
  const auto table = stages::stage_table();
  const pipeline::Config config = pipeline::load_config(arguments.config, table, arguments.sets);
  std::string names;
  for (const pipeline::ConfiguredStage& stage : config.stages)
    names += (names.empty() ? "" : ", ") + stage.stage->name;
  fmt::print("{}: ok\n  stages    {}\n  workspace {}\n  output    {}\n", arguments.config.string(), names,
             config.workspace.string(), config.output.string());
}

}  // namespace drape::app
