// Pixels of 16 bits a channel, for the few pictures that keep them.
#pragma once

#include <algorithm>
#include <cstdint>

#include "drape/geometry/image.hpp"

namespace drape {

using Image16 = Image<std::uint16_t>;  // as Image8, 65535 for 255

/// The nearest of 256 values, and the one of 65536 that means the same.
[[nodiscard]] constexpr std::uint8_t byte_from_deep(std::uint16_t value) {
  return static_cast<std::uint8_t>((value * 255U + 32767U) / 65535U);
}
[[nodiscard]] constexpr std::uint16_t deep_from_byte(std::uint8_t value) {
  return static_cast<std::uint16_t>(value * 257U);
}

[[nodiscard]] inline Image8 bytes_from_deep(const Image16& deep) {
  Image8 image(deep.width(), deep.height(), deep.channels());
  std::transform(deep.data().begin(), deep.data().end(), image.data().begin(), byte_from_deep);
  return image;
}
[[nodiscard]] inline Image16 deep_from_bytes(const Image8& image) {
  Image16 deep(image.width(), image.height(), image.channels());
  std::transform(image.data().begin(), image.data().end(), deep.data().begin(), deep_from_byte);
  return deep;
}

}  // namespace drape
