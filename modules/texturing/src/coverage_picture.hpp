// Which pixels of a photo are on the model.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "drape/geometry/image.hpp"

namespace drape::texturing {

using PixelTriangle = std::array<Eigen::Vector2d, 3>;

/// 1 where a pixel's centre lies in one of the triangles (pixel coordinates), and for triangles without a
/// centre the pixel of their middle; else 0.
[[nodiscard]] Image8 covered_pixels(const std::vector<PixelTriangle>& triangles, int width, int height);

/// RGB: covered pixels that are fully trusted as they are, the other covered ones tinted orange, the rest dim
/// grey.
[[nodiscard]] Image8 coverage_picture(const Image8& rgb, const Image8& covered, const Image8& trusted);

}  // namespace drape::texturing
