// What segmentation gets wrong about an outline.
#pragma once

#include <cstdint>

#include "drape/geometry/image.hpp"

namespace drape::lab {

/// The outline moved along its normal by Gaussian noise of this standard deviation in pixels, with a
/// correlation of exp(-(d / 8 px)^2) between points d apart.
[[nodiscard]] Image8 with_boundary_noise(const Image8& stencil, double sigma_px, std::uint64_t seed);

/// Without `share` of the object's pixels: a disc about a point of its outline, or all beyond a line, as an
/// occluder or the edge of a segment takes them away.
[[nodiscard]] Image8 with_missing_part(const Image8& stencil, double share, std::uint64_t seed);

/// With background joined to it, as many pixels as `share` of the object's: a disc about a point of its
/// outline, or a bar from its middle outwards. Fewer where the picture ends before.
[[nodiscard]] Image8 with_extra_part(const Image8& stencil, double share, std::uint64_t seed);

/// With holes, discs of 4 to 12 pixels' radius inside the object, that take away `share` of its pixels.
[[nodiscard]] Image8 with_pin_holes(const Image8& stencil, double share, std::uint64_t seed);

[[nodiscard]] int object_pixels(const Image8& stencil);

}  // namespace drape::lab
