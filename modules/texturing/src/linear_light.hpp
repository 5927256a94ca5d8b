// Between stored sRGB values and linear light (IEC 61966-2-1).
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace drape::texturing {

/// 0..255 as stored -> 0..1.
[[nodiscard]] float linear_from_byte(std::uint8_t stored);
/// 0..1, clamped, rounded to the nearest stored value.
[[nodiscard]] std::uint8_t byte_from_linear(float linear);

/// The same for whichever width of samples a picture has: 0..255 or 0..65535.
[[nodiscard]] inline float linear_from(std::uint8_t stored) {
  return linear_from_byte(stored);
}
[[nodiscard]] float linear_from(std::uint16_t stored);
template <class Sample>
[[nodiscard]] Sample stored_as(float linear);
template <>
[[nodiscard]] inline std::uint8_t stored_as<std::uint8_t>(float linear) {
  return byte_from_linear(linear);
}
template <>
[[nodiscard]] std::uint16_t stored_as<std::uint16_t>(float linear);
/// Stored 0..1 -> linear 0..1, per channel, and back.
[[nodiscard]] Eigen::Vector3f linear_from_stored(const Eigen::Vector3f& stored);
[[nodiscard]] Eigen::Vector3f stored_from_linear(const Eigen::Vector3f& linear);

}  // namespace drape::texturing
