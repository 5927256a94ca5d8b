// The photo's stencil at the size at which it is compared.
#pragma once

#include <Eigen/Core>

#include "drape/geometry/image.hpp"
#include "stencil_moments.hpp"

namespace drape::alignment {

struct ImageStencil {
  Image8 pixels;
  Image8 known;  // 1 where the pixel counts, else 0
  Moments moments;
  int box_left = 0, box_top = 0, box_right = 0, box_bottom = 0;  // of the object, inclusive
};

/// Error{input} for a stencil that is none: another number of channels, other values, no object, no
/// background.
void check_stencil(const Image8& stencil);

/// Nearest neighbour (thesis 4.2), the longer side `longest_px` or the photo's own where that is smaller.
/// Error{input} as align_photo says.
[[nodiscard]] ImageStencil image_stencil(const Image8& photo_stencil, int longest_px);

}  // namespace drape::alignment
