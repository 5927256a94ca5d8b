#include "drape/pipeline/file_digests.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "drape/base/error.hpp"
#include "drape/base/hash.hpp"
#include "json_file.hpp"

namespace drape::pipeline {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t young_ns = 2'000'000'000;

std::int64_t nanoseconds(const timespec& time) {
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

FileStat stat_of(const fs::path& file) {
  struct stat found {};
  if (::stat(file.c_str(), &found) != 0)
    throw input_error("{}: cannot read: {}", file.string(), std::strerror(errno));
  return {static_cast<std::uint64_t>(found.st_dev), static_cast<std::uint64_t>(found.st_ino),
          static_cast<std::uint64_t>(found.st_size), nanoseconds(found.st_mtim), nanoseconds(found.st_ctim)};
}

}  // namespace

FileDigests::FileDigests(fs::path memory) : memory_(std::move(memory)) {
  const std::optional<Json> json = read_json(memory_);
  if (!json) return;
  try {
    for (const Json& entry : json->at("files")) {
      Entry read;
      read.digest = entry.at("sha256");
      read.stat = {entry.at("device"), entry.at("inode"), entry.at("bytes"), entry.at("modified_ns"),
                   entry.at("changed_ns")};
      read.read_at_ns = entry.at("read_at_ns");
      remembered_[entry.at("file").get<std::string>()] = read;
    }
  } catch (const Json::exception&) {
    remembered_.clear();
  }
}

// The stat is taken before the bytes: if they change in between, the next look sees another stat.
FileDigests::Entry FileDigests::read(const fs::path& file) {
  Entry entry;
  entry.stat = stat_of(file);
  entry.read_at_ns = now_ns();
  entry.digest = sha256_file(file);
  return entry;
}

const std::string& FileDigests::of(const fs::path& file) {
  const auto known = asked_for_.find(file);
  if (known != asked_for_.end()) return known->second.digest;
  const auto before = remembered_.find(file);
  if (before != remembered_.end()) {
    const Entry& entry = before->second;
    const bool was_old =
        std::max(entry.stat.modified_ns, entry.stat.changed_ns) + young_ns < entry.read_at_ns;
    if (was_old && stat_of(file) == entry.stat) return asked_for_.emplace(file, entry).first->second.digest;
  }
  return asked_for_.emplace(file, read(file)).first->second.digest;
}

void FileDigests::check_unchanged() {
  for (auto& [file, entry] : asked_for_) {
    if (stat_of(file) == entry.stat) continue;
    Entry now = read(file);
    if (now.digest != entry.digest)
      throw Error(ErrorCode::try_again, file.string() + ": was written to while it was used; run again");
    entry = std::move(now);
  }
}

void FileDigests::save() const {
  Json json;
  json["files"] = Json::array();
  for (const auto& [file, entry] : asked_for_)
    json["files"].push_back({{"file", file.string()},
                             {"sha256", entry.digest},
                             {"device", entry.stat.device},
                             {"inode", entry.stat.inode},
                             {"bytes", entry.stat.bytes},
                             {"modified_ns", entry.stat.modified_ns},
                             {"changed_ns", entry.stat.changed_ns},
                             {"read_at_ns", entry.read_at_ns}});
  write_json(memory_, json);
}

}  // namespace drape::pipeline
