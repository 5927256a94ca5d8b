// Runs the stages of a configuration, each only if nothing that it depends on is there already.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "drape/pipeline/config.hpp"
#include "drape/pipeline/records.hpp"

namespace drape::pipeline {

struct RunOptions {
  std::string name;                  // of the run; empty: the configuration's
  std::optional<std::string> from;   // this stage and all later ones run again, results or not
  std::optional<std::string> until;  // the last stage
  std::optional<std::string> only;   // this stage runs again; no other stage runs
  bool publish = true;               // copy what the last stage makes to the configuration's output
  std::string command;               // for the record: what makes this run again
  std::vector<std::pair<std::string, std::string>> versions;  // of drape and its libraries, for the records
  const std::atomic<bool>* stop = nullptr;                    // set by a signal handler
};

/// Is told what happens, to show it.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  /// `number` of `count` stages, from 1; `why` it is not reused.
  virtual void stage_started(const Stage& stage, std::size_t number, std::size_t count,
                             const std::string& why) = 0;
  virtual void stage_progress(const Stage& stage, double fraction, std::string_view what) = 0;
  virtual void stage_finished(const Stage& stage, std::size_t number, std::size_t count,
                              const StageRecord& record, bool ran) = 0;
};

struct RunResult {
  RunRecord record;
  std::filesystem::path folder;                  // runs/<name>
  std::vector<StageRecord> stages;               // in the order of record.stages
  std::vector<std::filesystem::path> published;  // files in the configuration's output folder
  bool anything_ran = false;
};

/// Throws what a stage throws, after the run's record says so; a stage that fails leaves nothing behind.
/// A stage always reads committed files; before it does, their digests are checked, and what was damaged is
/// put aside and made again with a warning. Several processes may run at once: of one run, or results that
/// they share, the later ones wait and take what the first one made.
[[nodiscard]] RunResult run(const Config& config, const RunOptions& options, RunObserver& observer);

/// What a stage took when it ran.
struct StageCost {
  double seconds = 0;
  double peak_memory_mb = 0;
};

/// What run() would do with a stage.
struct Forecast {
  enum class State {
    up_to_date,  // would be reused
    would_run,   // would run, for the reasons given
    may_run      // would run if a stage before it, which would run, comes out different
  };
  std::string stage;
  State state = State::up_to_date;
  std::vector<std::string> reasons;
  std::optional<StageCost>
      cost;  // of running it, by earlier runs; nothing if there is none, or none is needed
};
[[nodiscard]] std::vector<Forecast> explain(const Config& config, const std::string& run_name);

}  // namespace drape::pipeline
