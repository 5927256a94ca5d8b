// A photo's stencil at one resolution.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "bit_raster.hpp"
#include "drape/geometry/image.hpp"
#include "outline_drawing.hpp"
#include "photo_plane.hpp"

namespace drape::alignment {

/// Where the outline passes between two pixels, by linear interpolation: in the window's pixels.
struct ContourPoint {
  Eigen::Vector2d at;
  Eigen::Vector2d outward;  // unit, from the object to the background, smoothed over a few pixels
  double length = 0;        // of outline that it stands for, in window pixels
};

struct StencilLevel {
  static constexpr std::int32_t none = -1;

  Window window;
  BitImage object;  // more than half of the pixel
  BitImage known;   // inside the photo, and said to be object or background
  std::vector<ContourPoint> contour;
  double contour_length = 0;
  Image<std::int32_t> nearest;  // contour point nearest to each pixel's centre, within the reach
};

/// Pixels of `step` x `step` photo pixels, about the box of the object with a margin. `reach_px`, in window
/// pixels, is how far off `nearest` knows the contour.
[[nodiscard]] StencilLevel stencil_level(const Image8& stencil, const PhotoPlane& plane, int step,
                                         double reach_px);

/// Longer side of the object's bounding box, in pixels.
[[nodiscard]] int object_extent(const Image8& stencil);

}  // namespace drape::alignment
