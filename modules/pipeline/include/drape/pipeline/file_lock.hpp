// Locks between processes that no dead process can hold: the kernel's open-file-description locks.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>

namespace drape::pipeline {

/// Held while the object lives. The file itself means nothing and stays.
class FileLock {
 public:
  enum class Kind { shared, exclusive };

  /// Waits until the lock is free; `on_wait` is called once if it is not. Error{io} if the file cannot be
  /// made or the file system has no locks; Interrupted if `stop` (may be null) is set meanwhile.
  [[nodiscard]] static FileLock acquire(const std::filesystem::path& file, Kind kind,
                                        const std::atomic<bool>* stop = nullptr,
                                        const std::function<void()>& on_wait = {});
  /// Nothing if another process holds it.
  [[nodiscard]] static std::optional<FileLock> try_acquire(const std::filesystem::path& file, Kind kind);
  /// Whether a process holds it, without taking or making anything.
  [[nodiscard]] static bool is_held(const std::filesystem::path& file);

  ~FileLock();
  FileLock(FileLock&& other) noexcept : handle_(other.handle_) { other.handle_ = -1; }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  FileLock& operator=(FileLock&&) = delete;

 private:
  explicit FileLock(int handle) : handle_(handle) {}
  int handle_;
};

}  // namespace drape::pipeline
