#include "color.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace drape::report {

float linear_from_srgb(float value) {
  return value <= 0.04045F ? value / 12.92F : std::pow((value + 0.055F) / 1.055F, 2.4F);
}

float srgb_from_linear(float value) {
  return value <= 0.0031308F ? 12.92F * value : 1.055F * std::pow(value, 1 / 2.4F) - 0.055F;
}

std::uint8_t byte_from_unit(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255.0F));
}

float linear_from_byte(std::uint8_t value) {
  static const auto table = [] {
    std::array<float, 256> light{};
    for (std::size_t i = 0; i < light.size(); ++i)
      light[i] = linear_from_srgb(static_cast<float>(i) / 255.0F);
    return light;
  }();
  return table[value];
}

std::uint8_t byte_from_linear(float light) {
  // sRGB is steepest at black, with 3295 codes per unit of light: a step of this table is 0.05 codes there.
  constexpr std::size_t steps = 65536;
  static const auto table = [] {
    std::vector<std::uint8_t> codes(steps + 1);
    for (std::size_t i = 0; i <= steps; ++i)
      codes[i] = byte_from_unit(srgb_from_linear(static_cast<float>(i) / static_cast<float>(steps)));
    return codes;
  }();
  return table[static_cast<std::size_t>(std::clamp(light, 0.0F, 1.0F) * static_cast<float>(steps) + 0.5F)];
}

Eigen::Vector3f linear_from_srgb(const Eigen::Vector3f& color) {
  return color.unaryExpr([](float value) { return linear_from_srgb(value); });
}

Eigen::Vector3f item_color(std::size_t index) {
  constexpr std::array lightness = {0.68F, 0.80F, 0.58F};
  constexpr float chroma = 0.125F;
  constexpr float golden_angle = 2.39996323F;  // radians: hues never come close to an earlier one for long
  const float hue = 0.9F + golden_angle * static_cast<float>(index);
  const float lab_l = lightness[index % lightness.size()];
  const float lab_a = chroma * std::cos(hue);
  const float lab_b = chroma * std::sin(hue);
  const float l = std::pow(lab_l + 0.3963377774F * lab_a + 0.2158037573F * lab_b, 3.0F);
  const float m = std::pow(lab_l - 0.1055613458F * lab_a - 0.0638541728F * lab_b, 3.0F);
  const float s = std::pow(lab_l - 0.0894841775F * lab_a - 1.2914855480F * lab_b, 3.0F);
  const Eigen::Vector3f linear(4.0767416621F * l - 3.3077115913F * m + 0.2309699292F * s,
                               -1.2684380046F * l + 2.6097574011F * m - 0.3413193965F * s,
                               -0.0041960863F * l - 0.7034186147F * m + 1.7076147010F * s);
  return linear.unaryExpr(
      [](float v) { return std::clamp(srgb_from_linear(std::max(v, 0.0F)), 0.0F, 1.0F); });
}

}  // namespace drape::report
