#include "linear_light.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace drape::texturing {
namespace {

float linear(float stored) {
  return stored <= 0.04045F ? stored / 12.92F : std::pow((stored + 0.055F) / 1.055F, 2.4F);
}

float stored(float linear_value) {
  const float value = std::clamp(linear_value, 0.F, 1.F);
  return value <= 0.0031308F ? 12.92F * value : 1.055F * std::pow(value, 1 / 2.4F) - 0.055F;
}

}  // namespace

float linear_from_byte(std::uint8_t value) {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> t{};
    for (std::size_t i = 0; i < t.size(); ++i) t[i] = linear(static_cast<float>(i) / 255.F);
    return t;
  }();
  return table[value];
}

std::uint8_t byte_from_linear(float value) {
  // Steps this fine are a twentieth of a byte where the curve is steepest.
  constexpr int steps = 65536;
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> t;
    for (int i = 0; i <= steps; ++i)
      t.push_back(static_cast<std::uint8_t>(std::lround(255.F * stored(static_cast<float>(i) / steps))));
    return t;
  }();
  return table[static_cast<std::size_t>(steps * std::clamp(value, 0.F, 1.F) + 0.5F)];
}

float linear_from(std::uint16_t value) {
  static const std::vector<float> table = [] {
    std::vector<float> t;
    for (int i = 0; i <= 65535; ++i) t.push_back(linear(static_cast<float>(i) / 65535.F));
    return t;
  }();
  return table[value];
}

template <>
std::uint16_t stored_as<std::uint16_t>(float value) {
  return static_cast<std::uint16_t>(std::lround(65535.F * stored(value)));
}

Eigen::Vector3f linear_from_stored(const Eigen::Vector3f& value) {
  return value.unaryExpr([](float v) { return linear(v); });
}

Eigen::Vector3f stored_from_linear(const Eigen::Vector3f& value) {
  return value.unaryExpr([](float v) { return stored(v); });
}

}  // namespace drape::texturing
