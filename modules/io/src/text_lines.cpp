#include "text_lines.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <limits>

namespace drape::io {
namespace {

bool blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

/// The value that std::from_chars leaves out: 0 for one too small for a double, infinite for one too large.
double out_of_range_value(std::string_view word) {
  const double sign = word.front() == '-' ? -1.0 : 1.0;
  const std::size_t exponent = word.find_first_of("eE");
  const bool tiny = exponent != std::string_view::npos ? word.substr(exponent + 1).starts_with('-')
                                                       : word.find_first_of("123456789") > word.find('.');
  return sign * (tiny ? 0.0 : std::numeric_limits<double>::infinity());
}

}  // namespace

TextLines::TextLines(std::string_view text, std::size_t first_line)
    : rest_(text), number_(first_line - 1), end_(text.find('\n') == std::string_view::npos ? '\r' : '\n') {}

bool TextLines::next() {
  if (rest_.empty()) return false;
  const void* found = std::memchr(rest_.data(), end_, rest_.size());
  ended_ = found != nullptr;
  const std::size_t length =
      ended_ ? static_cast<std::size_t>(static_cast<const char*>(found) - rest_.data()) : rest_.size();
  line_ = rest_.substr(0, length);
  rest_.remove_prefix(ended_ ? length + 1 : length);
  if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
  ++number_;
  return true;
}

bool TextLines::next_filled() {
  while (next())
    if (!std::all_of(line_.begin(), line_.end(), blank)) return true;
  return false;
}

void Words::skip_blanks() {
  std::size_t i = 0;
  while (i < rest_.size() && (blank(rest_[i]) || rest_[i] == separator_)) ++i;
  rest_.remove_prefix(i);
}

std::string_view Words::next() {
  skip_blanks();
  std::size_t i = 0;
  while (i < rest_.size() && !blank(rest_[i]) && rest_[i] != separator_) ++i;
  const std::string_view word = rest_.substr(0, i);
  rest_.remove_prefix(i);
  return word;
}

std::string_view Words::rest() {
  skip_blanks();
  return rest_;
}

std::optional<double> parse_value(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  if (word.empty() || word.front() == '+') return std::nullopt;
  double value = 0;
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (problem == std::errc::invalid_argument) return std::nullopt;
  if (end != word.data() + word.size()) {
    // "1.#QNAN", "-1.#IND", "1.#INF": neither is a place in space.
    const std::string_view tail(end, static_cast<std::size_t>(word.data() + word.size() - end));
    if (tail.starts_with('#') && (value == 1 || value == -1)) return std::numeric_limits<double>::quiet_NaN();
    return std::nullopt;
  }
  return problem == std::errc::result_out_of_range ? out_of_range_value(word) : value;
}

std::string shown(std::string_view word) {
  std::string text(word.substr(0, 40));
  for (char& c : text)
    if (c < ' ' || c > '~') c = '?';
  return "\"" + text + (word.size() > 40 ? "...\"" : "\"");
}

}  // namespace drape::io
