// LZF (Lehmann's LibLZF), the compression of PCD files.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace drape::io {

/// Exactly `size` bytes, or nothing if the codes make more or fewer or point before their beginning.
[[nodiscard]] std::optional<std::string> lzf_decompressed(std::string_view codes, std::size_t size);

/// The most bytes that so many codes can make: 3 bytes make at most 264.
[[nodiscard]] constexpr std::uint64_t most_lzf_bytes(std::uint64_t codes) {
  return 88 * codes;
}

}  // namespace drape::io
