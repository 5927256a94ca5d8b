// The one exception type of drape, and how it maps to the exit code of the program.
#pragma once

#include <fmt/core.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace drape {

enum class ErrorCode {
  config,     // wrong command line or configuration file: exit 64
  input,      // an input file is missing, damaged or makes no sense: exit 65
  bug,        // drape broke one of its own promises: exit 70
  io,         // writing failed, the disk is full, no permission: exit 74
  try_again,  // a resource is busy now; the same call may work later: exit 75
};

/// Bad input or a bad environment. The message names the file and, where it can, the line or byte, in words
/// that tell the user what to do. Only apps/ catches it.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
};

/// Thrown by Progress::update after an interrupt (Ctrl-C, SIGTERM) was asked for.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// 64, 65, 70, 74 or 75, as sysexits.h names them.
[[nodiscard]] int exit_code(ErrorCode code);

template <class... Args>
[[nodiscard]] Error input_error(fmt::format_string<Args...> format, Args&&... args) {
  return {ErrorCode::input, fmt::format(format, std::forward<Args>(args)...)};
}

template <class... Args>
[[nodiscard]] Error config_error(fmt::format_string<Args...> format, Args&&... args) {
  return {ErrorCode::config, fmt::format(format, std::forward<Args>(args)...)};
}

template <class... Args>
[[nodiscard]] Error io_error(fmt::format_string<Args...> format, Args&&... args) {
  return {ErrorCode::io, fmt::format(format, std::forward<Args>(args)...)};
}

}  // namespace drape
