#include "attribute_scale.hpp"

#include <algorithm>
#include <cmath>

namespace drape::io {

std::vector<float> scaled_intensities(std::vector<float> values, double full_scale) {
  double least = 0;
  double most = 0;
  for (const double value : values)
    if (std::isfinite(value)) {
      least = std::min(least, value);
      most = std::max(most, value);
    }
  double offset = 0;
  double scale = full_scale;
  if (least < 0 && least >= -2048 && most <= 2047 && most - least > 2) {
    offset = 2048;
    scale = 4095;
  } else if (scale <= 0) {
    scale = most <= 1 ? 1 : most <= 255 ? 255 : most <= 65535 ? 65535 : most;
  }
  for (float& value : values)
    value = std::isfinite(value)
                ? static_cast<float>(std::clamp((static_cast<double>(value) + offset) / scale, 0.0, 1.0))
                : 0.0F;
  return values;
}

std::vector<Eigen::Vector3f> scaled_colors(std::vector<Eigen::Vector3f> colors, double full_scale) {
  double scale = full_scale;
  if (scale <= 0) {
    double most = 0;
    for (const Eigen::Vector3f& color : colors)
      for (const double channel : color)
        if (std::isfinite(channel)) most = std::max(most, channel);
    scale = most <= 1 ? 1 : most <= 255 ? 255 : 65535;
  }
  const auto full = static_cast<float>(scale);
  for (Eigen::Vector3f& color : colors)
    for (float& value : color)
      // The division of floats is what the writers undo: byte / 255.
      value = std::isfinite(value) ? std::clamp(value, 0.0F, full) / full : 0.0F;
  return colors;
}

Eigen::Vector3f unit_normal(const Eigen::Vector3d& normal) {
  if (!normal.allFinite()) return Eigen::Vector3f::Zero();
  return normal.stableNormalized().cast<float>();
}

std::vector<Eigen::Vector3f> unit_normals(std::span<const Eigen::Vector3d> normals) {
  std::vector<Eigen::Vector3f> units;
  units.reserve(normals.size());
  for (const Eigen::Vector3d& normal : normals) units.push_back(unit_normal(normal));
  return units;
}

float clamped_confidence(double value) {
  return std::isfinite(value) ? static_cast<float>(std::clamp(value, 0.0, 1.0)) : 0.0F;
}

std::vector<float> clamped_confidences(std::span<const double> values) {
  std::vector<float> clamped;
  clamped.reserve(values.size());
  for (const double value : values) clamped.push_back(clamped_confidence(value));
  return clamped;
}

}  // namespace drape::io
