#include "intensity_scale.hpp"

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

}  // namespace drape::io
