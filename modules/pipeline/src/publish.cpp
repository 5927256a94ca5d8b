#include "publish.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"

namespace drape::pipeline {
namespace fs = std::filesystem;
namespace {

void sync(const fs::path& path) {
  const int handle = ::open(path.c_str(), O_RDONLY);
  const bool synced = handle >= 0 && ::fsync(handle) == 0;
  const int problem = errno;
  if (handle >= 0) ::close(handle);
  if (!synced) throw io_error("{}: cannot be written safely: {}", path.string(), std::strerror(problem));
}

bool same_file(const fs::path& file, const StageFile& wanted, FileDigests& digests) {
  std::error_code problem;
  return fs::is_regular_file(file, problem) && fs::file_size(file, problem) == wanted.bytes && !problem &&
         digests.of(file) == wanted.digest;
}

}  // namespace

std::vector<fs::path> publish(const StageRecord& record, const fs::path& folder, const fs::path& output,
                              FileDigests& digests) {
  std::vector<fs::path> files;
  bool copied = false;
  for (const StageFile& entry : record.files) {
    const fs::path target = output / entry.name;
    files.push_back(target);
    if (same_file(target, entry, digests)) continue;
    make_folder(target.parent_path());
    write_file_aside(target, [&](const fs::path& aside) {
      std::error_code problem;
      fs::copy_file(folder / entry.name, aside, fs::copy_options::overwrite_existing, problem);
      if (problem) throw io_error("{}: cannot write: {}", target.string(), problem.message());
      sync(aside);
    });
    copied = true;
  }
  if (copied) sync(output);
  return files;
}

}  // namespace drape::pipeline
