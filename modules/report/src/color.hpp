// Colours that can be told apart.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

namespace drape::report {

/// IEC 61966-2-1: sRGB value in 0..1 to linear light and back.
[[nodiscard]] float linear_from_srgb(float value);
[[nodiscard]] float srgb_from_linear(float value);

[[nodiscard]] std::uint8_t byte_from_unit(float value);  // clamped, rounded

/// The same for stored bytes, by table. There and back gives the same byte.
[[nodiscard]] float linear_from_byte(std::uint8_t value);
[[nodiscard]] std::uint8_t byte_from_linear(float light);  // clamped
[[nodiscard]] Eigen::Vector3f linear_from_srgb(const Eigen::Vector3f& color);

/// sRGB colour of the item with this number: neighbours differ much in hue and a little in lightness, so that
/// they are told apart without hue as well. (Oklab, Ottosson 2020.)
[[nodiscard]] Eigen::Vector3f item_color(std::size_t index);

}  // namespace drape::report
