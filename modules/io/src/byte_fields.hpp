// Numbers of fixed size in the bytes of a little-endian file.
#pragma once

#include <bit>
#include <cstring>
#include <string_view>

namespace drape::io {

static_assert(std::endian::native == std::endian::little, "little-endian files are read by copying bytes");

/// The caller knows that the bytes are there.
template <class Number>
[[nodiscard]] Number load(std::string_view bytes, std::size_t at) {
  Number value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace drape::io
