#include "drape/pipeline/file_lock.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"

namespace drape::pipeline {
namespace {

struct flock whole_file(FileLock::Kind kind) {
  struct flock lock {};
  lock.l_type = kind == FileLock::Kind::shared ? F_RDLCK : F_WRLCK;
  lock.l_whence = SEEK_SET;
  return lock;
}

}  // namespace

std::optional<FileLock> FileLock::try_acquire(const std::filesystem::path& file, Kind kind) {
  make_folder(file.parent_path());
  const int handle = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (handle < 0) throw io_error("{}: cannot be made: {}", file.string(), std::strerror(errno));
  FileLock lock(handle);
  struct flock wanted = whole_file(kind);
  if (::fcntl(handle, F_OFD_SETLK, &wanted) == 0) return lock;
  if (errno != EAGAIN && errno != EACCES)
    throw io_error("{}: cannot be locked: {}", file.string(), std::strerror(errno));
  return std::nullopt;
}

FileLock FileLock::acquire(const std::filesystem::path& file, Kind kind, const std::atomic<bool>* stop,
                           const std::function<void()>& on_wait) {
  // Polled, not F_OFD_SETLKW: an interrupt must end the wait.
  for (bool told = false;; told = true) {
    if (std::optional<FileLock> lock = try_acquire(file, kind)) return std::move(*lock);
    if (!told && on_wait) on_wait();
    if (stop != nullptr && *stop) throw Interrupted();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

bool FileLock::is_held(const std::filesystem::path& file) {
  const int handle = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (handle < 0) return false;
  struct flock wanted = whole_file(Kind::exclusive);
  const bool asked = ::fcntl(handle, F_OFD_GETLK, &wanted) == 0;
  ::close(handle);
  return asked && wanted.l_type != F_UNLCK;
}

FileLock::~FileLock() {
  if (handle_ >= 0) ::close(handle_);
}

}  // namespace drape::pipeline
