// Messages to the user and to the run's log file. Modules call info / warn; apps/ decides where they go.
#pragma once

#include <fmt/core.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace drape::log {

enum class Level { debug, info, warning };

/// Sends a message to every sink. Thread-safe.
void write(Level level, std::string_view message);

template <class... Args>
void debug(fmt::format_string<Args...> format, Args&&... args) {
  write(Level::debug, fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void info(fmt::format_string<Args...> format, Args&&... args) {
  write(Level::info, fmt::format(format, std::forward<Args>(args)...));
}
/// Something the user should know that does not stop the work: it is shown, and kept in the stage's record.
template <class... Args>
void warn(fmt::format_string<Args...> format, Args&&... args) {
  write(Level::warning, fmt::format(format, std::forward<Args>(args)...));
}

/// The least level that is printed to standard error. Default: info.
void set_console_level(Level level);

/// While it lives, every message also goes to `file` (created, truncated).
class FileSink {
 public:
  explicit FileSink(const std::filesystem::path& file);
  ~FileSink();
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;

 private:
  struct Impl;
  Impl* impl_;
};

/// While it lives, warnings are collected, so that a stage's record can hold them.
class WarningCapture {
 public:
  WarningCapture();
  ~WarningCapture();
  WarningCapture(const WarningCapture&) = delete;
  WarningCapture& operator=(const WarningCapture&) = delete;
  [[nodiscard]] std::vector<std::string> warnings() const;

 private:
  struct Impl;
  Impl* impl_;
};

}  // namespace drape::log
