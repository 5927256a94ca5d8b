// Numbers as text, the same in every locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace drape {

/// The whole of `text` as a number (decimal, exponent, optional leading +), or nothing. "nan" and "inf" parse
/// as the values they name: a caller that does not want them checks with std::isfinite.
[[nodiscard]] std::optional<double> parse_double(std::string_view text);
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view text);

/// The shortest decimal that reads back as the same value.
[[nodiscard]] std::string format_number(double value);
[[nodiscard]] std::string format_number(float value);

}  // namespace drape
