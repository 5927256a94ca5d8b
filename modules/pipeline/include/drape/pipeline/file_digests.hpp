// Digests of files, each computed once, and remembered from run to run as long as the file system says that
// the file is the same.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace drape::pipeline {

/// What a file system tells of a file without reading it.
struct FileStat {
  std::uint64_t device = 0;
  std::uint64_t inode = 0;
  std::uint64_t bytes = 0;
  std::int64_t modified_ns = 0;
  std::int64_t changed_ns = 0;

  bool operator==(const FileStat&) const = default;
};

/// SHA-256 of files. A digest of an earlier run is taken over where device, inode, size and both times are
/// what they were, and the file was older than two seconds when it was read: a younger one may have been
/// written to again within one tick of the file system's clock.
class FileDigests {
 public:
  FileDigests() = default;
  /// Remembers what save() wrote to this file; a missing or damaged one only costs time.
  explicit FileDigests(std::filesystem::path memory);

  /// Error{input} if the file cannot be read.
  [[nodiscard]] const std::string& of(const std::filesystem::path& file);
  /// Error{try_again} naming a file whose digest was asked for and that was written to since.
  void check_unchanged();
  /// Writes down what was asked for, in place of what was remembered. Error{io}.
  void save() const;

 private:
  struct Entry {
    std::string digest;
    FileStat stat;
    std::int64_t read_at_ns = 0;
  };
  [[nodiscard]] static Entry read(const std::filesystem::path& file);

  std::filesystem::path memory_;
  std::map<std::filesystem::path, Entry> remembered_;
  std::map<std::filesystem::path, Entry> asked_for_;
};

}  // namespace drape::pipeline
