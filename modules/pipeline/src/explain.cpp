#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "artifacts.hpp"
#include "drape/pipeline/engine.hpp"
#include "drape/pipeline/workspace.hpp"

namespace drape::pipeline {
namespace {

// The parts that the stage's result in the last run of this name was made from.
std::optional<StageRecord> last_result(const Workspace& workspace, const std::optional<RunRecord>& last,
                                       const std::string& stage) {
  if (!last) return std::nullopt;
  for (const RunStage& entry : last->stages)
    if (entry.stage == stage)
      return read_stage_record(workspace.stage_folder(stage, entry.key) / "stage.json");
  return std::nullopt;
}

bool is_file_of(const KeyPart& part, const std::set<std::string>& stages) {
  return std::any_of(stages.begin(), stages.end(), [&](const std::string& stage) {
    return part.name.rfind("file." + stage + "/", 0) == 0;
  });
}

}  // namespace

std::vector<Forecast> explain(const Config& config, const std::string& run_name) {
  const Workspace workspace(config.workspace);
  const std::string name = run_name.empty() ? config.name : run_name;
  const std::optional<RunRecord> last = read_run_record(workspace.run_folder(name) / "run.json");
  std::map<std::string, StageRecord> results;
  std::set<std::string> open;  // stages whose outputs are not known before they run
  InputDigests digests;
  std::vector<Forecast> forecasts;
  for (const ConfiguredStage& configured : config.stages) {
    const Stage& stage = *configured.stage;
    Forecast forecast{stage.name, Forecast::State::up_to_date, {}};
    std::vector<KeyPart> parts = key_parts(configured, config, upstream_digests(stage, results), digests);
    std::set<std::string> open_reads;
    for (const Artifact& artifact : stage.reads)
      if (open.count(artifact.stage) != 0) open_reads.insert(artifact.stage);

    if (open_reads.empty()) {
      if (auto record = workspace.find(stage.name, key_of(stage.name, parts))) {
        results[stage.name] = std::move(*record);
        forecasts.push_back(std::move(forecast));
        continue;
      }
    }
    open.insert(stage.name);
    std::optional<StageRecord> before = last_result(workspace, last, stage.name);
    if (!before) {
      forecast.state = Forecast::State::would_run;
      forecast.reasons = {fmt::format("it has no result in run {}", name)};
    } else {
      std::erase_if(before->parts, [&](const KeyPart& part) { return is_file_of(part, open_reads); });
      forecast.reasons = differences(stage.name, before->parts, parts);
      if (forecast.reasons.empty() && open_reads.empty())
        forecast.reasons = {"its result is gone or damaged"};
      forecast.state = forecast.reasons.empty() ? Forecast::State::may_run : Forecast::State::would_run;
    }
    for (const std::string& upstream : open_reads)
      forecast.reasons.push_back(fmt::format("reads {}, which would run", upstream));
    forecasts.push_back(std::move(forecast));
  }
  return forecasts;
}

}  // namespace drape::pipeline
