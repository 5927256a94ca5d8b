// Figures as people read them.
#pragma once

#include <string>
#include <string_view>

#include "drape/report/page.hpp"

namespace drape::report {

/// Four significant digits, no exponent between 1e-4 and 1e7, thousands set apart by thin spaces; whole
/// numbers in full: 362272 -> "362 272", 0.123456 -> "0.1235", 96.40012 -> "96.4".
[[nodiscard]] std::string readable_value(double value);

/// "0.04 s", "12.3 s", "3 min 12 s", "2 h 05 min".
[[nodiscard]] std::string readable_seconds(double seconds);

/// Of megabytes (10^6 bytes): "812 MB", "1.46 GB".
[[nodiscard]] std::string readable_memory(double megabytes);

/// A number whose name ends in its unit, as metrics and options do: "boundary_error_px" with 1.25 becomes
/// "boundary error", "1.25", "px". Lengths in metres are shown in the unit that suits them (0.00035 m as
/// 0.35 mm).
[[nodiscard]] Number readable_number(std::string_view name_with_unit, double value, std::string meaning = {});

}  // namespace drape::report
