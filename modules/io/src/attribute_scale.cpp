#include "attribute_scale.hpp"

#include <algorithm>
#include <cmath>

namespace drape::io {

std::vector<float> scaled_intensities(std::span<const double> values, double full_scale) {
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
  std::vector<float> scaled;
  scaled.reserve(values.size());
  for (const double value : values)
    scaled.push_back(std::isfinite(value) ? static_cast<float>(std::clamp((value + offset) / scale, 0.0, 1.0))
                                          : 0.0F);
  return scaled;
}

std::vector<Eigen::Vector3f> scaled_colors(std::span<const Eigen::Vector3d> colors, double full_scale) {
  double scale = full_scale;
  if (scale <= 0) {
    double most = 0;
    for (const Eigen::Vector3d& color : colors)
      for (const double channel : color)
        if (std::isfinite(channel)) most = std::max(most, channel);
    scale = most <= 1 ? 1 : most <= 255 ? 255 : 65535;
  }
  const auto channel = [&](double value) {
    // The division of floats is what the writers undo: byte / 255.
    return std::isfinite(value)
               ? static_cast<float>(std::clamp(value, 0.0, scale)) / static_cast<float>(scale)
               : 0.0F;
  };
  std::vector<Eigen::Vector3f> scaled;
  scaled.reserve(colors.size());
  for (const Eigen::Vector3d& color : colors)
    scaled.emplace_back(channel(color.x()), channel(color.y()), channel(color.z()));
  return scaled;
}

std::vector<Eigen::Vector3f> unit_normals(std::span<const Eigen::Vector3d> normals) {
  std::vector<Eigen::Vector3f> units;
  units.reserve(normals.size());
  for (const Eigen::Vector3d& normal : normals) {
    const bool finite = normal.allFinite();
    units.push_back(finite ? Eigen::Vector3f(normal.stableNormalized().cast<float>())
                           : Eigen::Vector3f(0, 0, 0));
  }
  return units;
}

std::vector<float> clamped_confidences(std::span<const double> values) {
  std::vector<float> clamped;
  clamped.reserve(values.size());
  for (const double value : values)
    clamped.push_back(std::isfinite(value) ? static_cast<float>(std::clamp(value, 0.0, 1.0)) : 0.0F);
  return clamped;
}

}  // namespace drape::io
