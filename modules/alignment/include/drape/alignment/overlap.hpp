// How much of two stencils is the same.
#pragma once

#include "drape/geometry/image.hpp"

namespace drape::alignment {

/// 100 * intersection / union of the object pixels; pixels that are unknown in either stencil are left out.
/// 0 if no object pixel is left. Error{input} unless both have one channel and the same size.
[[nodiscard]] double overlap_percent(const Image8& first, const Image8& second);

}  // namespace drape::alignment
