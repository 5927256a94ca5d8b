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
  [[nodiscard]] std::filesystem::path run_folder(const std::string& run) const;

  /// The record of a whole result: stage.json reads well and every file is there with its size.
  [[nodiscard]] std::optional<StageRecord> find(const std::string& stage, const std::string& key) const;

  /// Where a result is written before it is committed: its own name for each process. What dead processes
  /// left of this key is removed.
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

  /// All run records, newest first.
  [[nodiscard]] std::vector<RunRecord> runs() const;

 private:
  std::filesystem::path folder_;
};

}  // namespace drape::pipeline
