#include "drape/base/files.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <system_error>

#include "drape/base/error.hpp"

namespace drape {
namespace fs = std::filesystem;

std::string read_file(const fs::path& file) {
  std::error_code problem;
  if (!fs::exists(file, problem)) throw input_error("{}: no such file", file.string());
  if (fs::is_directory(file, problem)) throw input_error("{}: is a folder, not a file", file.string());
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> handle(std::fopen(file.c_str(), "rb"), &std::fclose);
  if (!handle) throw input_error("{}: cannot read: {}", file.string(), std::strerror(errno));
  std::string bytes;
  const std::uintmax_t size = fs::file_size(file, problem);
  if (!problem) bytes.reserve(size);
  char buffer[1 << 16];
  while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, handle.get()))
    bytes.append(buffer, count);
  if (std::ferror(handle.get()))
    throw input_error("{}: cannot read: {}", file.string(), std::strerror(errno));
  return bytes;
}

FileBytes::FileBytes(const fs::path& file) {
  constexpr std::uintmax_t least_mapped = 64 << 20;
  std::error_code problem;
  const std::uintmax_t size = fs::is_regular_file(file, problem) ? fs::file_size(file, problem) : 0;
  if (problem || size < least_mapped) {
    loaded_ = read_file(file);
    view_ = loaded_;
    return;
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> handle(std::fopen(file.c_str(), "rb"), &std::fclose);
  if (!handle) throw input_error("{}: cannot read: {}", file.string(), std::strerror(errno));
  mapped_ = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, ::fileno(handle.get()), 0);
  if (mapped_ == MAP_FAILED) {
    mapped_ = nullptr;
    throw input_error("{}: cannot read: {}", file.string(), std::strerror(errno));
  }
  ::madvise(mapped_, size, MADV_SEQUENTIAL);
  view_ = {static_cast<const char*>(mapped_), size};
}

FileBytes::~FileBytes() {
  if (mapped_ != nullptr) ::munmap(mapped_, view_.size());
}

void write_file_aside(const fs::path& file, const std::function<void(const fs::path&)>& write) {
  const fs::path aside = file.parent_path() / (file.filename().string() + ".writing");
  try {
    write(aside);
    fs::rename(aside, file);
  } catch (const fs::filesystem_error& failure) {
    std::error_code ignored;
    fs::remove(aside, ignored);
    throw io_error("{}: cannot write: {}", file.string(), failure.code().message());
  } catch (...) {
    std::error_code ignored;
    fs::remove(aside, ignored);
    throw;
  }
}

void write_file(const fs::path& file, std::string_view bytes) {
  write_file_aside(file, [&](const fs::path& aside) {
    std::FILE* handle = std::fopen(aside.c_str(), "wb");
    if (handle == nullptr) throw io_error("{}: cannot write: {}", file.string(), std::strerror(errno));
    const bool written = std::fwrite(bytes.data(), 1, bytes.size(), handle) == bytes.size();
    const int write_errno = errno;
    if (std::fclose(handle) != 0 || !written)
      throw io_error("{}: cannot write: {}", file.string(), std::strerror(written ? errno : write_errno));
  });
}

void make_folder(const fs::path& folder) {
  std::error_code problem;
  fs::create_directories(folder, problem);
  if (problem) throw io_error("{}: cannot create the folder: {}", folder.string(), problem.message());
}

std::string extension(const fs::path& file) {
  std::string text = file.extension().string();
  if (!text.empty()) text.erase(0, 1);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c); });
  return text;
}

}  // namespace drape
