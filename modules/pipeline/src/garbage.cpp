#include "drape/pipeline/garbage.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <ctime>
#include <set>

#include "drape/base/error.hpp"
#include "drape/pipeline/file_lock.hpp"

namespace drape::pipeline {
namespace fs = std::filesystem;
namespace {

std::uint64_t bytes_in(const fs::path& folder) {
  std::uint64_t bytes = 0;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, ignored))
    if (entry.is_regular_file(ignored)) bytes += entry.file_size(ignored);
  return bytes;
}

std::int64_t modified_s(const fs::path& path) {
  struct stat found {};
  return ::stat(path.c_str(), &found) == 0 ? std::int64_t{found.st_mtim.tv_sec} : 0;
}

// "stage/key" of everything that a run, however deep below runs/, links to or names. A record that cannot be
// read still has its links.
std::set<std::string> used_results(const Workspace& workspace) {
  std::set<std::string> used;
  const fs::path runs = workspace.folder() / "runs";
  std::error_code problem;
  if (!fs::exists(runs, problem)) return used;
  // Errors are thrown here: what cannot be looked at might link to anything.
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(runs)) {
    if (entry.is_symlink()) {
      const fs::path target = fs::read_symlink(entry.path());
      used.insert(target.parent_path().filename().string() + "/" + target.filename().string());
    } else if (entry.path().filename() == "run.json") {
      if (const auto record = read_run_record(entry.path()))
        for (const RunStage& stage : record->stages) used.insert(stage.stage + "/" + stage.key);
    }
  }
  return used;
}

Garbage find(const Workspace& workspace, std::optional<std::uint64_t> max_bytes, double min_age_s,
             bool alone) {
  const std::set<std::string> used = used_results(workspace);
  const std::int64_t newest = std::int64_t{std::time(nullptr)} - static_cast<std::int64_t>(min_age_s);
  Garbage garbage;
  std::vector<Garbage::Item> unused;
  std::error_code ignored;
  for (const fs::directory_entry& stage : fs::directory_iterator(workspace.folder() / "stages", ignored))
    for (const fs::directory_entry& entry : fs::directory_iterator(stage.path(), ignored)) {
      const std::string name = entry.path().filename().string();
      Garbage::Item item{entry.path(), "", bytes_in(entry.path()), modified_s(entry.path())};
      if (name.find('.') == std::string::npos) {
        if (used.count(stage.path().filename().string() + "/" + name) != 0) {
          garbage.linked_bytes += item.bytes;
          continue;
        }
        item.why = "no run links to it";
        if (item.modified_s <= newest)
          unused.push_back(std::move(item));
        else
          garbage.kept_bytes += item.bytes;
        continue;
      }
      const bool damaged = name.find(".damaged-") != std::string::npos;
      const bool at_work = !alone && FileLock::is_held(workspace.result_lock(stage.path().filename().string(),
                                                                             name.substr(0, name.find('.'))));
      if (at_work || (damaged && item.modified_s > newest)) continue;
      item.why = damaged ? "damaged, put aside" : "left by a process that died";
      garbage.items.push_back(std::move(item));
    }
  const auto older = [](const Garbage::Item& a, const Garbage::Item& b) {
    return a.modified_s != b.modified_s ? a.modified_s < b.modified_s : a.path < b.path;
  };
  std::sort(unused.begin(), unused.end(), older);
  std::uint64_t total = garbage.linked_bytes + garbage.kept_bytes;
  for (const Garbage::Item& item : unused) total += item.bytes;
  for (Garbage::Item& item : unused) {
    if (max_bytes && total <= *max_bytes) {
      garbage.kept_bytes += item.bytes;
      continue;
    }
    total -= item.bytes;
    garbage.items.push_back(std::move(item));
  }
  std::sort(garbage.items.begin(), garbage.items.end(), older);
  for (const Garbage::Item& item : garbage.items) garbage.garbage_bytes += item.bytes;
  return garbage;
}

}  // namespace

Garbage find_garbage(const Workspace& workspace, std::optional<std::uint64_t> max_bytes, double min_age_s) {
  return find(workspace, max_bytes, min_age_s, false);
}

Garbage remove_garbage(const Workspace& workspace, std::optional<std::uint64_t> max_bytes, double min_age_s) {
  const std::optional<FileLock> alone =
      FileLock::try_acquire(workspace.users_lock(), FileLock::Kind::exclusive);
  if (!alone)
    throw Error(ErrorCode::try_again, workspace.folder().string() +
                                          ": drape is at work in this workspace; try again when it is done");
  Garbage garbage = find(workspace, max_bytes, min_age_s, true);
  for (const Garbage::Item& item : garbage.items) {
    std::error_code problem;
    fs::remove_all(item.path, problem);
    if (problem) throw io_error("{}: cannot be removed: {}", item.path.string(), problem.message());
  }
  // Nobody holds or waits for a lock on a result: that needs the lock that is held here.
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(workspace.folder() / "locks", ignored))
    if (entry.path() != workspace.users_lock()) fs::remove(entry.path(), ignored);
  return garbage;
}

}  // namespace drape::pipeline
