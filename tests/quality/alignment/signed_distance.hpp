// How far every pixel is from an outline.
#pragma once

#include "drape/geometry/image.hpp"

namespace drape::lab {

/// Pixels from each pixel's centre to the nearest centre of the other kind, less half a pixel: positive in
/// the object, negative outside of it.
[[nodiscard]] ImageF signed_distance(const Image8& stencil);

}  // namespace drape::lab
