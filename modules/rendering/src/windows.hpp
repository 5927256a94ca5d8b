// Pictures larger than a frame buffer are drawn piece by piece.
#pragma once

#include <algorithm>
#include <vector>

#include "clip_matrix.hpp"
#include "drape/base/error.hpp"

namespace drape::rendering {

inline constexpr int most_side = 16384;        // of a picture
inline constexpr int most_samples = 16;        // per side of a pixel
inline constexpr int most_buffer_side = 4096;  // of a frame buffer, in samples

/// Error{input} for a camera whose image has no pixels or too many.
inline void check_size(const Camera& camera) {
  if (camera.width < 1 || camera.height < 1 || camera.width > most_side || camera.height > most_side)
    throw input_error("cannot draw a picture of {} x {} pixels; each side must be within 1 and {}",
                      camera.width, camera.height, most_side);
}

/// Windows that cover the camera's image, row by row.
inline std::vector<Window> windows_of(const Camera& camera, int samples) {
  check_size(camera);
  if (samples < 1 || samples > most_samples)
    throw input_error("samples_per_side is {}; must be within 1 and {}", samples, most_samples);
  std::vector<Window> windows;
  const int side = most_buffer_side / samples;
  for (int y = 0; y < camera.height; y += side)
    for (int x = 0; x < camera.width; x += side)
      windows.push_back({x, y, std::min(side, camera.width - x), std::min(side, camera.height - y), samples});
  return windows;
}

}  // namespace drape::rendering
