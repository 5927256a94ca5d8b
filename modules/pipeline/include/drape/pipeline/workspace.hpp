// The folder with all results: stages/<stage>/<key>/ and runs/<name>/.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "drape/pipeline/records.hpp"

namespace drape::pipeline {

class Workspace {
 public:
  explicit Workspace(std::filesystem::path folder) : folder_(std::move(folder)) {}

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] std::filesystem::path stage_folder(const std::string& stage, const std::string& key) const;
  /// A run's name may have folders in it: "batch/object".
  [[nodiscard]] std::filesystem::path run_folder(const std::string& run) const;

  /// The record of a whole result: stage.json reads well and every file is there with its size.
  [[nodiscard]] std::optional<StageRecord> find(const std::string& stage, const std::string& key) const;

  /// Held shared by whoever reads or writes results, and exclusively by what removes them.
  [[nodiscard]] std::filesystem::path users_lock() const { return folder_ / "locks" / "users"; }
  /// Held by the one process that makes this result.
  [[nodiscard]] std::filesystem::path result_lock(const std::string& stage, const std::string& key) const;
  /// Held by the one process that works on this run.
  [[nodiscard]] std::filesystem::path run_lock(const std::string& run) const;
  /// Held by the one process that copies finished files to this folder.
  [[nodiscard]] std::filesystem::path output_lock(const std::filesystem::path& output) const;

  /// An empty folder where a result is written before it is committed. The caller holds result_lock(): what
  /// is there already was left by a process that is dead.
  [[nodiscard]] std::filesystem::path begin(const std::string& stage, const std::string& key) const;
  /// Renames what begin() gave to its final name, in place of what may be there.
  void commit(const std::filesystem::path& writing, const std::string& stage, const std::string& key) const;
  /// Moves a result that is not what its record says out of the way; returns where it went.
  std::filesystem::path set_aside(const std::string& stage, const std::string& key) const;

  /// runs/<run>/<number>-<stage> -> the result; replaces an older link.
  void link(const std::string& run, std::size_t number, const std::string& stage,
            const std::string& key) const;
  /// Removes links to stages that the run no longer has: all whose name is not in `kept`.
  void drop_links_except(const std::string& run, const std::vector<std::string>& kept) const;

  /// All run records directly below runs/, newest first. Of a run that says that it is running but whose
  /// process is gone, the status is "interrupted".
  [[nodiscard]] std::vector<RunRecord> runs() const;

 private:
  std::filesystem::path folder_;
};

}  // namespace drape::pipeline
