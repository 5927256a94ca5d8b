#include "drape/pipeline/engine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <map>
#include <set>
#include <tuple>

#include "adopted_parts.hpp"
#include "artifacts.hpp"
#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/hash.hpp"
#include "drape/base/log.hpp"
#include "drape/pipeline/adoption.hpp"
#include "drape/pipeline/file_lock.hpp"
#include "drape/pipeline/workspace.hpp"
#include "execution.hpp"
#include "peak_memory.hpp"
#include "publish.hpp"

namespace drape::pipeline {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// A result whose bytes are not what its record says.
struct DamagedResult {
  std::string stage;
  std::string key;
  std::string file;
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
  }

  RunResult execute() {
    const FileLock user = wait_for(workspace_.users_lock(), FileLock::Kind::shared, "results are removed");
    const FileLock alone = wait_for(workspace_.run_lock(result_.record.name), FileLock::Kind::exclusive,
                                    "run " + result_.record.name + " is at work");
    make_folder(result_.folder);
    const log::FileSink log_file(result_.folder / "run.log");
    begin();
    log::debug("{}", options_.command);
    try {
      walk_until_sound();
    } catch (const Interrupted&) {
      finish_after_failure("interrupted", "interrupted");
      throw;
    } catch (const std::exception& failure) {
      log::debug("failed: {}", failure.what());
      finish_after_failure("failed", failure.what());
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

  [[nodiscard]] FileLock wait_for(const fs::path& file, FileLock::Kind kind, const std::string& what) const {
    return FileLock::acquire(file, kind, options_.stop,
                             [&] { log::info("waiting for another drape process: {}", what); });
  }

  // Until the run is finished its record says that it is running, with the results of the time before: should
  // this process die, what changed since can still be told.
  void begin() {
    last_ = read_run_record(result_.folder / "run.json");
    adoptions_ = read_adoptions(workspace_, result_.record.name);
    digests_ = FileDigests(result_.folder / "digests.json");
    published_digests_ = FileDigests(result_.folder / "published.json");
    RunRecord running = result_.record;
    running.status = "running";
    if (last_) running.stages = last_->stages;
    write_run_record(result_.folder / "run.json", running);
  }

  // A damaged result is found when a stage wants to read it; then it is put aside and the walk starts again,
  // which makes just that one anew. Each turn removes one damaged folder, so the turns end.
  void walk_until_sound() {
    while (true) {
      try {
        walk();
        return;
      } catch (const DamagedResult& damaged) {
        set_aside(damaged);
      }
    }
  }

  void set_aside(const DamagedResult& damaged) const {
    const FileLock lock =
        wait_for(workspace_.result_lock(damaged.stage, damaged.key), FileLock::Kind::exclusive,
                 "a damaged result of " + damaged.stage + " is made again");
    // Another process may have put it right meanwhile.
    if (const auto record = workspace_.find(damaged.stage, damaged.key); record && is_sound(*record)) return;
    const fs::path aside = workspace_.set_aside(damaged.stage, damaged.key);
    log::warn("{}/{} was changed or damaged since it was made; it was moved to {} and is made again",
              damaged.stage, damaged.file, aside.string());
  }

  [[nodiscard]] bool is_sound(const StageRecord& record) const {
    const fs::path folder = workspace_.stage_folder(record.stage, record.key);
    return std::all_of(record.files.begin(), record.files.end(),
                       [&](const StageFile& file) { return sha256_file(folder / file.name) == file.digest; });
  }

  [[nodiscard]] std::vector<Adoption> adopted_for(const std::string& stage) const {
    std::vector<Adoption> adopted;
    for (const Adoption& adoption : adoptions_)
      if (adoption.stage == stage) adopted.push_back(adoption);
    return adopted;
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

      std::vector<KeyPart> parts =
          key_parts(configured, config_, upstream_digests(*configured.stage, results_), digests_);
      add_adopted(parts, adopted_for(name));
      const std::string key = key_of(name, parts);
      std::optional<StageRecord> record;
      if (!forced) record = workspace_.find(name, key);
      if (!record && !may_run) {
        // What comes after the stage that was asked for is linked as far as it still fits.
        if (after_only) break;
        throw config_error("stage {} has no result that fits this configuration; run without --only first",
                           name);
      }
      const Clock::time_point start = Clock::now();
      bool ran = false;
      if (!record) std::tie(record, ran) = make_or_take(i, parts, key, forced);
      if (forced) forced_.insert(name);
      after_only = after_only || options_.only == name;

      observer_.stage_finished(*configured.stage, i + 1, config_.stages.size(), *record, ran);
      workspace_.link(result_.record.name, i + 1, name, key);
      links.push_back(fmt::format("{}-{}", i + 1, name));
      result_.anything_ran = result_.anything_ran || ran;
      result_.record.stages.push_back({name, key, ran, ran ? seconds_since(start) : 0.0});
      result_.stages.push_back(*record);
      results_[name] = std::move(*record);
      if (configured.stage->published && options_.publish) publish_files(results_[name]);
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

  // Makes the result, unless another process made it while this one waited for the lock on it.
  std::pair<StageRecord, bool> make_or_take(std::size_t index, const std::vector<KeyPart>& parts,
                                            const std::string& key, bool forced) {
    const std::string& name = config_.stages[index].stage->name;
    const FileLock lock = wait_for(workspace_.result_lock(name, key), FileLock::Kind::exclusive,
                                   "the same result of " + name + " is being made");
    if (!forced)
      if (std::optional<StageRecord> record = workspace_.find(name, key)) return {std::move(*record), false};
    return {make(index, parts, key, forced ? "asked for" : ""), true};
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
      digests_.check_unchanged();
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
    const std::vector<Adoption> adopted = adopted_for(stage.name);
    if (adopted.empty())
      configured.instance.run(execution);
    else
      write_adopted(configured, adopted, folder, parts, execution);
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

  // The stage's own files, made if they are not there, with the adopted ones in their places.
  void write_adopted(const ConfiguredStage& configured, const std::vector<Adoption>& adopted,
                     const fs::path& folder, const std::vector<KeyPart>& parts, Execution& execution) {
    const Stage& stage = *configured.stage;
    const std::string own_key = key_of(stage.name, without_adopted(parts));
    if (const auto own = workspace_.find(stage.name, own_key)) {
      for (const StageFile& file : own->files) {
        const fs::path source = workspace_.stage_folder(stage.name, own_key) / file.name;
        if (sha256_file(source) != file.digest) throw DamagedResult{stage.name, own_key, file.name};
        write_file(execution.output(file.name), read_file(source));
      }
      execution.metrics = own->metrics;
    } else if (!covers(adopted, stage)) {
      configured.instance.run(execution);
    }
    for (const Adoption& adoption : adopted) {
      const fs::path source = adopted_file(workspace_, result_.record.name, adoption);
      write_file(execution.output(adoption.file), read_file(source));
      if (sha256_file(folder / adoption.file) != adoption.digest)
        throw input_error("{}: is not the file that was adopted; adopt it again", source.string());
      execution.metric("adopted_" + adoption.file, adoption.came_from);
    }
  }

  void publish_files(const StageRecord& record) {
    const FileLock lock = wait_for(workspace_.output_lock(config_.output), FileLock::Kind::exclusive,
                                   config_.output.string() + " is written");
    result_.published = publish(record, workspace_.stage_folder(record.stage, record.key), config_.output,
                                published_digests_);
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
    digests_.save();
    published_digests_.save();
  }

  // The failure itself is what the user must hear, not that it could not be written down too.
  void finish_after_failure(const std::string& status, const std::string& reason) {
    try {
      finish(status, {reason});
    } catch (const std::exception& second) {
      log::warn("{}", second.what());
    }
  }

  const Config& config_;
  const RunOptions& options_;
  RunObserver& observer_;
  Workspace workspace_;
  Clock::time_point start_ = Clock::now();
  std::optional<RunRecord> last_;
  std::vector<Adoption> adoptions_;
  FileDigests digests_;
  FileDigests published_digests_;
  Results results_;
  std::set<std::string> forced_;  // stages that were made again already, should the walk start anew
  RunResult result_;
};

}  // namespace

RunResult run(const Config& config, const RunOptions& options, RunObserver& observer) {
  return Run(config, options, observer).execute();
}

}  // namespace drape::pipeline
