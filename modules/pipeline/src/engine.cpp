#include "drape/pipeline/engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <map>
#include <set>

#include "artifacts.hpp"
#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/hash.hpp"
#include "drape/base/log.hpp"
#include "drape/pipeline/workspace.hpp"
#include "peak_memory.hpp"
#include "publish.hpp"

namespace drape::pipeline {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::steady_clock;
using Results = std::map<std::string, StageRecord>;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// A result whose bytes are not what its record says.
struct DamagedResult {
  std::string stage;
  std::string key;
  std::string file;
};

// What a stage sees of the engine.
class Execution : public StageRun {
 public:
  Execution(const Stage& stage, const Config& config, const Workspace& workspace, const Results& results,
            fs::path folder, Progress progress)
      : stage_(stage),
        config_(config),
        workspace_(workspace),
        results_(results),
        folder_(std::move(folder)),
        progress_(std::move(progress)) {}

  [[nodiscard]] const Input& input() const override { return config_.input; }

  [[nodiscard]] bool has_artifact(std::string_view stage, std::string_view file) const override {
    const auto result = results_.find(std::string(stage));
    if (result == results_.end()) return false;
    const auto& files = result->second.files;
    return std::any_of(files.begin(), files.end(), [&](const StageFile& f) { return f.name == file; });
  }

  [[nodiscard]] fs::path artifact(std::string_view stage, std::string_view file) const override {
    const bool named = std::any_of(stage_.reads.begin(), stage_.reads.end(), [&](const Artifact& a) {
      return a.stage == stage && matches(a.pattern, file);
    });
    // What is not in `reads` is not in the key either.
    if (!named || !has_artifact(stage, file))
      throw Error(ErrorCode::bug,
                  fmt::format("stage {} asks for {}/{}, which it does not read or is not there", stage_.name,
                              stage, file));
    return workspace_.stage_folder(std::string(stage), results_.at(std::string(stage)).key) / file;
  }

  [[nodiscard]] fs::path output(std::string_view file) override {
    if (std::none_of(stage_.writes.begin(), stage_.writes.end(),
                     [&](const std::string& p) { return matches(p, file); }))
      throw Error(ErrorCode::bug,
                  fmt::format("stage {} writes {}, which its row does not name", stage_.name, file));
    fs::path path = folder_ / file;
    make_folder(path.parent_path());
    return path;
  }

  [[nodiscard]] const Progress& progress() const override { return progress_; }
  [[nodiscard]] std::uint64_t seed() const override { return config_.seed; }
  void metric(std::string name, std::variant<double, std::string> value) override {
    metrics.emplace_back(std::move(name), std::move(value));
  }
  void needs_review(std::string reason) override { review_reasons.push_back(std::move(reason)); }

  std::vector<Metric> metrics;
  std::vector<std::string> review_reasons;

 private:
  const Stage& stage_;
  const Config& config_;
  const Workspace& workspace_;
  const Results& results_;
  fs::path folder_;
  Progress progress_;
};

std::vector<StageFile> list_files(const fs::path& folder) {
  std::vector<StageFile> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files.push_back({entry.path().lexically_relative(folder).generic_string(), sha256_file(entry.path()),
                       static_cast<std::uint64_t>(entry.file_size())});
  std::sort(files.begin(), files.end(),
            [](const StageFile& a, const StageFile& b) { return a.name < b.name; });
  return files;
}

// One run from its first stage to its last.
class Run {
 public:
  Run(const Config& config, const RunOptions& options, RunObserver& observer)
      : config_(config), options_(options), observer_(observer), workspace_(config.workspace) {
    result_.record.name = options.name.empty() ? config.name : options.name;
    result_.record.config_file = config.file.string();
    result_.record.config_text = config.text;
    result_.record.sets = config.sets;
    result_.record.command = options.command;
    result_.record.output = config.output.string();
    result_.record.started_at = utc_now();
    result_.folder = workspace_.run_folder(result_.record.name);
    check_stage_name(options.from);
    check_stage_name(options.until);
    check_stage_name(options.only);
    last_ = read_run_record(result_.folder / "run.json");
  }

  RunResult execute() {
    make_folder(result_.folder);
    const log::FileSink log_file(result_.folder / "run.log");
    log::debug("{}", options_.command);
    try {
      walk_until_sound();
    } catch (const Interrupted&) {
      finish("interrupted", {"interrupted"});
      throw;
    } catch (const std::exception& failure) {
      log::debug("failed: {}", failure.what());
      finish("failed", {failure.what()});
      throw;
    }
    std::vector<std::string> reasons;
    for (const StageRecord& record : result_.stages)
      for (const std::string& reason : record.review_reasons) reasons.push_back(record.stage + ": " + reason);
    finish(reasons.empty() ? "ok" : "review", reasons);
    return std::move(result_);
  }

 private:
  void check_stage_name(const std::optional<std::string>& name) const {
    if (!name) return;
    std::vector<std::string> names;
    for (const ConfiguredStage& configured : config_.stages) names.push_back(configured.stage->name);
    if (std::find(names.begin(), names.end(), *name) != names.end()) return;
    const std::string guess = closest(*name, names);
    throw config_error("{}: no such stage in this run; it has {}{}", *name, fmt::join(names, ", "),
                       guess.empty() ? "" : "; did you mean " + guess + "?");
  }

  // A damaged result is found when a stage wants to read it; then it is put aside and the walk starts again,
  // which makes just that one anew. Each turn removes one damaged folder, so the turns end.
  void walk_until_sound() {
    while (true) {
      try {
        walk();
        return;
      } catch (const DamagedResult& damaged) {
        const fs::path aside = workspace_.set_aside(damaged.stage, damaged.key);
        log::warn("{}/{} was changed or damaged since it was made; it was moved to {} and is made again",
                  damaged.stage, damaged.file, aside.string());
      }
    }
  }

  void walk() {
    result_.stages.clear();
    result_.record.stages.clear();
    results_.clear();
    bool after_from = false;
    bool after_only = false;
    std::vector<std::string> links;
    for (std::size_t i = 0; i < config_.stages.size(); ++i) {
      const ConfiguredStage& configured = config_.stages[i];
      const std::string& name = configured.stage->name;
      after_from = after_from || options_.from == name;
      const bool forced = (after_from || options_.only == name) && forced_.count(name) == 0;
      const bool may_run = !options_.only || options_.only == name;

      const std::vector<KeyPart> parts =
          key_parts(configured, config_, upstream_digests(*configured.stage, results_), digests_);
      const std::string key = key_of(name, parts);
      std::optional<StageRecord> record;
      if (!forced) record = workspace_.find(name, key);
      const bool ran = !record;
      if (ran && !may_run) {
        // What comes after the stage that was asked for is linked as far as it still fits.
        if (after_only) break;
        throw config_error("stage {} has no result that fits this configuration; run without --only first",
                           name);
      }
      const Clock::time_point start = Clock::now();
      if (ran) record = make(i, parts, key, forced ? "asked for" : "");
      if (forced) forced_.insert(name);
      after_only = after_only || options_.only == name;

      observer_.stage_finished(*configured.stage, i + 1, config_.stages.size(), *record, ran);
      workspace_.link(result_.record.name, i + 1, name, key);
      links.push_back(fmt::format("{}-{}", i + 1, name));
      result_.anything_ran = result_.anything_ran || ran;
      result_.record.stages.push_back({name, key, ran, ran ? seconds_since(start) : 0.0});
      result_.stages.push_back(*record);
      results_[name] = std::move(*record);
      if (configured.stage->published)
        result_.published = publish(results_[name], workspace_.stage_folder(name, key), config_.output);
      if (options_.until == name) break;
    }
    workspace_.drop_links_except(result_.record.name, links);
  }

  std::string reason_to_run(const Stage& stage, const std::vector<KeyPart>& parts) const {
    if (last_)
      for (const RunStage& entry : last_->stages) {
        if (entry.stage != stage.name) continue;
        const auto before = read_stage_record(workspace_.stage_folder(stage.name, entry.key) / "stage.json");
        if (!before) return "its result is gone or damaged";
        const std::vector<std::string> changes = differences(stage.name, before->parts, parts);
        if (changes.empty()) return "its result is gone or damaged";
        return changes.size() == 1 ? changes[0]
                                   : fmt::format("{}, and {} more", changes[0], changes.size() - 1);
      }
    return "first time";
  }

  void check_reads(const Stage& stage) const {
    for (const Artifact& artifact : stage.reads) {
      const auto result = results_.find(artifact.stage);
      if (result == results_.end()) continue;
      for (const StageFile& file : result->second.files)
        if (matches(artifact.pattern, file.name) &&
            sha256_file(workspace_.stage_folder(artifact.stage, result->second.key) / file.name) !=
                file.digest)
          throw DamagedResult{artifact.stage, result->second.key, file.name};
    }
  }

  StageRecord make(std::size_t index, const std::vector<KeyPart>& parts, const std::string& key,
                   const std::string& why) {
    const ConfiguredStage& configured = config_.stages[index];
    const Stage& stage = *configured.stage;
    check_reads(stage);
    observer_.stage_started(stage, index + 1, config_.stages.size(),
                            why.empty() ? reason_to_run(stage, parts) : why);
    const fs::path folder = workspace_.begin(stage.name, key);
    try {
      StageRecord record = write_result(configured, folder, parts, key);
      warn_if_not_deterministic(record);
      workspace_.commit(folder, stage.name, key);
      return record;
    } catch (...) {
      std::error_code ignored;
      fs::remove_all(folder, ignored);
      throw;
    }
  }

  StageRecord write_result(const ConfiguredStage& configured, const fs::path& folder,
                           const std::vector<KeyPart>& parts, const std::string& key) {
    const Stage& stage = *configured.stage;
    const log::WarningCapture warnings;
    const Progress progress(
        [&](double fraction, std::string_view what) { observer_.stage_progress(stage, fraction, what); },
        options_.stop);
    Execution execution(stage, config_, workspace_, results_, folder, progress);
    reset_peak_memory();
    const Clock::time_point start = Clock::now();
    progress.update(0);
    configured.instance.run(execution);
    progress.update(1);
    StageRecord record;
    record.stage = stage.name;
    record.key = key;
    record.parts = parts;
    record.seconds = seconds_since(start);
    record.peak_memory_mb = peak_memory_mb();
    record.files = list_files(folder);
    record.made_at = utc_now();
    record.versions = options_.versions;
    record.metrics = std::move(execution.metrics);
    record.warnings = warnings.warnings();
    record.review_reasons = std::move(execution.review_reasons);
    write_stage_record(folder / "stage.json", record);
    return record;
  }

  void warn_if_not_deterministic(const StageRecord& made) const {
    const std::optional<StageRecord> before = workspace_.find(made.stage, made.key);
    if (!before) return;
    for (const StageFile& file : before->files)
      for (const StageFile& again : made.files)
        if (file.name == again.name && file.digest != again.digest)
          log::warn("stage {}: {} came out with other bytes than before, from the same inputs", made.stage,
                    file.name);
  }

  void finish(const std::string& status, std::vector<std::string> reasons) {
    result_.record.status = status;
    result_.record.reasons = std::move(reasons);
    result_.record.seconds = seconds_since(start_);
    write_run_record(result_.folder / "run.json", result_.record);
  }

  const Config& config_;
  const RunOptions& options_;
  RunObserver& observer_;
  Workspace workspace_;
  Clock::time_point start_ = Clock::now();
  std::optional<RunRecord> last_;
  InputDigests digests_;
  Results results_;
  std::set<std::string> forced_;  // stages that were made again already, should the walk start anew
  RunResult result_;
};

}  // namespace

RunResult run(const Config& config, const RunOptions& options, RunObserver& observer) {
  return Run(config, options, observer).execute();
}

}  // namespace drape::pipeline
