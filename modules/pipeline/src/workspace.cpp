#include "drape/pipeline/workspace.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/hash.hpp"
#include "drape/pipeline/file_lock.hpp"

namespace drape::pipeline {
namespace fs = std::filesystem;
namespace {

void rename_or_throw(const fs::path& from, const fs::path& to) {
  std::error_code problem;
  fs::rename(from, to, problem);
  if (problem) throw io_error("{}: cannot rename to {}: {}", from.string(), to.string(), problem.message());
}

}  // namespace

fs::path Workspace::stage_folder(const std::string& stage, const std::string& key) const {
  return folder_ / "stages" / stage / key;
}

fs::path Workspace::run_folder(const std::string& run) const {
  return folder_ / "runs" / run;
}

fs::path Workspace::result_lock(const std::string& stage, const std::string& key) const {
  return folder_ / "locks" / fmt::format("{}-{}", stage, key);
}

fs::path Workspace::run_lock(const std::string& run) const {
  return folder_ / "locks" / ("run-" + sha256(run).substr(0, 16));
}

fs::path Workspace::output_lock(const fs::path& output) const {
  return folder_ / "locks" / ("output-" + sha256(output.string()).substr(0, 16));
}

std::optional<StageRecord> Workspace::find(const std::string& stage, const std::string& key) const {
  const fs::path folder = stage_folder(stage, key);
  std::optional<StageRecord> record = read_stage_record(folder / "stage.json");
  if (!record || record->key != key) return std::nullopt;
  for (const StageFile& file : record->files) {
    std::error_code problem;
    if (fs::file_size(folder / file.name, problem) != file.bytes || problem) return std::nullopt;
  }
  return record;
}

fs::path Workspace::begin(const std::string& stage, const std::string& key) const {
  const fs::path writing = folder_ / "stages" / stage / (key + ".writing");
  std::error_code problem;
  fs::remove_all(writing, problem);
  if (problem) throw io_error("{}: cannot be removed: {}", writing.string(), problem.message());
  make_folder(writing);
  return writing;
}

void Workspace::commit(const fs::path& writing, const std::string& stage, const std::string& key) const {
  const fs::path target = stage_folder(stage, key);
  if (fs::exists(target)) {
    // Exchanged in one step where the file system can; in any case never half of the old and half of the new.
    fs::path old = writing;
    if (::renameat2(AT_FDCWD, writing.c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) != 0) {
      old = target.string() + ".old.writing";
      rename_or_throw(target, old);
      rename_or_throw(writing, target);
    }
    std::error_code ignored;
    fs::remove_all(old, ignored);
    return;
  }
  rename_or_throw(writing, target);
}

fs::path Workspace::set_aside(const std::string& stage, const std::string& key) const {
  const fs::path target = stage_folder(stage, key);
  fs::path aside;
  for (int i = 1; aside.empty() || fs::exists(aside); ++i)
    aside = fmt::format("{}.damaged-{}", target.string(), i);
  rename_or_throw(target, aside);
  return aside;
}

void Workspace::link(const std::string& run, std::size_t number, const std::string& stage,
                     const std::string& key) const {
  const fs::path folder = run_folder(run);
  make_folder(folder);
  const fs::path name = folder / fmt::format("{}-{}", number, stage);
  const fs::path target = stage_folder(stage, key).lexically_relative(folder);
  std::error_code problem;
  if (fs::read_symlink(name, problem) == target) return;
  const fs::path aside = folder / fmt::format(".{}-{}.{}", number, stage, ::getpid());
  fs::remove(aside, problem);
  fs::create_directory_symlink(target, aside, problem);
  if (problem) throw io_error("{}: cannot link: {}", name.string(), problem.message());
  rename_or_throw(aside, name);
}

void Workspace::drop_links_except(const std::string& run, const std::vector<std::string>& kept) const {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(run_folder(run), ignored))
    if (entry.is_symlink(ignored) &&
        std::find(kept.begin(), kept.end(), entry.path().filename().string()) == kept.end())
      fs::remove(entry.path(), ignored);
}

std::vector<RunRecord> Workspace::runs() const {
  std::vector<RunRecord> records;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "runs", ignored))
    if (std::optional<RunRecord> record = read_run_record(entry.path() / "run.json")) {
      if (record->status == "running" && !FileLock::is_held(run_lock(record->name)))
        record->status = "interrupted";
      records.push_back(std::move(*record));
    }
  std::sort(records.begin(), records.end(), [](const RunRecord& a, const RunRecord& b) {
    return a.started_at != b.started_at ? a.started_at > b.started_at : a.name < b.name;
  });
  return records;
}

}  // namespace drape::pipeline
