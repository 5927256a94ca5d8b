#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "adopted_parts.hpp"
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

// Of the run's own last result of the stage; else the median of those that the workspace has.
std::optional<StageCost> earlier_cost(const Workspace& workspace, const std::optional<RunRecord>& last,
                                      const std::string& stage) {
  constexpr std::size_t most_looked_at = 25;
  if (const auto record = last_result(workspace, last, stage))
    return StageCost{record->seconds, record->peak_memory_mb};
  std::vector<StageCost> costs;
  std::error_code ignored;
  for (const auto& entry :
       std::filesystem::directory_iterator(workspace.folder() / "stages" / stage, ignored)) {
    if (costs.size() == most_looked_at) break;
    if (const auto record = read_stage_record(entry.path() / "stage.json"))
      costs.push_back({record->seconds, record->peak_memory_mb});
  }
  if (costs.empty()) return std::nullopt;
  const auto middle = costs.begin() + static_cast<std::ptrdiff_t>(costs.size() / 2);
  std::nth_element(costs.begin(), middle, costs.end(),
                   [](const StageCost& a, const StageCost& b) { return a.seconds < b.seconds; });
  return *middle;
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
  FileDigests digests(workspace.run_folder(name) / "digests.json");
  const std::vector<Adoption> adoptions = read_adoptions(workspace, name);
  std::vector<Forecast> forecasts;
  for (const ConfiguredStage& configured : config.stages) {
    const Stage& stage = *configured.stage;
    Forecast forecast{stage.name, Forecast::State::up_to_date, {}, {}};
    std::vector<KeyPart> parts = key_parts(configured, config, upstream_digests(stage, results), digests);
    std::vector<Adoption> adopted;
    for (const Adoption& adoption : adoptions)
      if (adoption.stage == stage.name) adopted.push_back(adoption);
    add_adopted(parts, adopted);
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
    forecast.cost = earlier_cost(workspace, last, stage.name);
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
