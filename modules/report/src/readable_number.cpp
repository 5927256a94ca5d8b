#include "drape/report/readable_number.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace drape::report {
namespace {

constexpr std::string_view thin_space = "\u2009";

struct Unit {
  std::string_view suffix;
  std::string_view shown;
};

// Suffixes of names as the project writes them.
constexpr std::array units = {Unit{"percent", "%"}, Unit{"deg", "\u00b0"}, Unit{"px", "px"},
                              Unit{"mm", "mm"},     Unit{"m", "m"},        Unit{"spacings", "spacings"},
                              Unit{"s", "s"},       Unit{"seconds", "s"},  Unit{"mb", "MB"},
                              Unit{"db", "dB"},     Unit{"rad", "rad"}};

std::string grouped(std::string digits) {
  const std::size_t first = digits.front() == '-' ? 1 : 0;
  const std::size_t point = std::min(digits.find('.'), digits.size());
  if (point - first <= 4) return digits;
  for (std::size_t at = point; at > first + 3;) digits.insert(at -= 3, thin_space);
  return digits;
}

std::string without_trailing_zeros(std::string digits) {
  if (digits.find('.') == std::string::npos) return digits;
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.back() == '.') digits.pop_back();
  return digits;
}

Number length(Number number, double metres) {
  const double size = std::abs(metres);
  const auto [factor, unit] = size == 0 || size >= 1 ? std::pair(1.0, "m")
                              : size >= 1e-4         ? std::pair(1e3, "mm")
                                                     : std::pair(1e6, "\u00b5m");
  number.value_text = readable_value(metres * factor);
  number.unit = unit;
  return number;
}

}  // namespace

std::string readable_value(double value) {
  if (std::isnan(value)) return "not known";
  if (std::isinf(value)) return value > 0 ? "\u221e" : "\u2212\u221e";
  const double size = std::abs(value);
  if (value == std::round(value) && size < 1e15) return grouped(fmt::format("{:.0f}", value + 0.0));
  if (size < 1e-4 || size >= 1e7) return fmt::format("{:.3e}", value);
  const int decimals = std::clamp(3 - static_cast<int>(std::floor(std::log10(size))), 0, 8);
  return grouped(without_trailing_zeros(fmt::format("{:.{}f}", value, decimals)));
}

std::string readable_seconds(double seconds) {
  if (seconds < 0.995) return fmt::format("{:.2f} s", seconds);
  if (seconds < 59.95) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<long>(std::lround(seconds));
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  const long minutes = std::lround(seconds / 60);
  return fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
}

std::string readable_memory(double megabytes) {
  if (megabytes < 999.5) return fmt::format("{:.0f} MB", megabytes);
  return fmt::format("{:.2f} GB", megabytes / 1000);
}

Number readable_number(std::string_view name_with_unit, double value, std::string meaning) {
  Number number;
  number.meaning = std::move(meaning);
  std::string_view name = name_with_unit;
  std::string_view suffix;
  if (const std::size_t last = name.rfind('_'); last != std::string_view::npos) {
    const auto unit = std::find_if(units.begin(), units.end(),
                                   [&](const Unit& u) { return u.suffix == name.substr(last + 1); });
    if (unit != units.end()) {
      suffix = unit->suffix;
      number.unit = unit->shown;
      name = name.substr(0, last);
    }
  }
  number.name = name;
  std::replace(number.name.begin(), number.name.end(), '_', ' ');
  number.value_text = readable_value(value);
  return suffix == "m" ? length(std::move(number), value) : number;
}

}  // namespace drape::report
