// Lines on pictures.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "drape/geometry/image.hpp"

namespace drape::stages {

/// Gives every pixel of a one-channel picture whose centre is within half the width of the line through the
/// points the value, one pixel at least under each corner. What lies outside the picture is left out.
void draw_line(Image8& picture, const std::vector<std::array<double, 2>>& points_px, double width_px,
               std::uint8_t value);

}  // namespace drape::stages
