// The lines of a text file and the words in them, for readers that must name the line of an error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "drape/base/error.hpp"

namespace drape::io {

/// Lines that end in \n, \r\n or (in a text without any \n) \r.
class TextLines {
 public:
  explicit TextLines(std::string_view text, std::size_t first_line = 1);

  /// Moves to the next line; false at the end of the text.
  bool next();
  /// Moves to the next line that holds more than blanks; false at the end of the text.
  bool next_filled();
  [[nodiscard]] std::string_view line() const { return line_; }
  /// Of the current line, from `first_line` on; of the last one after the end.
  [[nodiscard]] std::size_t number() const { return number_; }
  /// What lies behind the current line.
  [[nodiscard]] std::string_view rest() const { return rest_; }
  /// Whether the current line was ended by a line end rather than by the end of the text.
  [[nodiscard]] bool ended() const { return ended_; }

 private:
  std::string_view rest_;
  std::string_view line_;
  std::size_t number_;
  char end_;
  bool ended_ = true;
};

/// The words of a line, split at blanks, tabs and any one further separator.
class Words {
 public:
  explicit Words(std::string_view line, char separator = ' ') : rest_(line), separator_(separator) {}

  /// Empty at the end of the line.
  [[nodiscard]] std::string_view next();
  /// What is left, without leading blanks.
  [[nodiscard]] std::string_view rest();

 private:
  void skip_blanks();
  std::string_view rest_;
  char separator_;
};

/// A number as scanners write it: also "nan", "inf", MSVC's "1.#QNAN"; a number too small or too large for a
/// double becomes 0 or infinite. Nothing if it is no number.
[[nodiscard]] std::optional<double> parse_value(std::string_view word);

/// What is wrong with a line, as `file:line: ...`.
template <class... Args>
[[nodiscard]] Error line_error(const std::string& file, std::size_t line, fmt::format_string<Args...> format,
                               Args&&... args) {
  return {ErrorCode::input,
          fmt::format("{}:{}: {}", file, line, fmt::format(format, std::forward<Args>(args)...))};
}

/// What is wrong at a byte, as `file: byte N: ...`.
template <class... Args>
[[nodiscard]] Error byte_error(const std::string& file, std::uint64_t byte,
                               fmt::format_string<Args...> format, Args&&... args) {
  return {ErrorCode::input,
          fmt::format("{}: byte {}: {}", file, byte, fmt::format(format, std::forward<Args>(args)...))};
}

/// A word of the file for a message: cut if it is long, bytes that do not print as `?`.
[[nodiscard]] std::string shown(std::string_view word);

}  // namespace drape::io
