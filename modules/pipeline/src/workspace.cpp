#include "drape/pipeline/workspace.hpp"

#include <fmt/core.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/numbers.hpp"

namespace drape::pipeline {
namespace fs = std::filesystem;
namespace {

void rename_or_throw(const fs::path& from, const fs::path& to) {
  std::error_code problem;
  fs::rename(from, to, problem);
  if (problem) throw io_error("{}: cannot rename to {}: {}", from.string(), to.string(), problem.message());
}

bool process_lives(std::int64_t pid) {
  return ::kill(static_cast<pid_t>(pid), 0) == 0 || errno == EPERM;
}

// <key>.<pid>.writing of processes that are no more.
void remove_leftovers(const fs::path& folder, const std::string& key) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(key + ".", 0) != 0 || entry.path().extension() != ".writing") continue;
    const auto pid = parse_integer(name.substr(key.size() + 1, name.size() - key.size() - 9));
    if (!pid || *pid == ::getpid() || !process_lives(*pid)) fs::remove_all(entry.path(), ignored);
  }
}

}  // namespace

fs::path Workspace::stage_folder(const std::string& stage, const std::string& key) const {
  return folder_ / "stages" / stage / key;
}

fs::path Workspace::run_folder(const std::string& run) const {
  return folder_ / "runs" / run;
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
  const fs::path parent = folder_ / "stages" / stage;
  make_folder(parent);
  remove_leftovers(parent, key);
  fs::path writing = parent / fmt::format("{}.{}.writing", key, ::getpid());
  make_folder(writing);
  return writing;
}

void Workspace::commit(const fs::path& writing, const std::string& stage, const std::string& key) const {
  const fs::path target = stage_folder(stage, key);
  if (fs::exists(target)) {
    const fs::path old = target.parent_path() / fmt::format("{}.{}.old.writing", key, ::getpid());
    rename_or_throw(target, old);
    rename_or_throw(writing, target);
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
  const fs::path target = fs::path("..") / ".." / "stages" / stage / key;
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
    if (std::optional<RunRecord> record = read_run_record(entry.path() / "run.json"))
      records.push_back(std::move(*record));
  std::sort(records.begin(), records.end(), [](const RunRecord& a, const RunRecord& b) {
    return a.started_at != b.started_at ? a.started_at > b.started_at : a.name < b.name;
  });
  return records;
}

}  // namespace drape::pipeline
