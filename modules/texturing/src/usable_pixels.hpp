// Which pixels of a photo may paint the model.
#pragma once

#include "drape/geometry/image.hpp"

namespace drape::texturing {

/// How far a pixel can be trusted to show the object.
namespace trust {
inline constexpr std::uint8_t none = 0;
inline constexpr std::uint8_t near = 1;  // not itself, but colours can be grown to it
inline constexpr std::uint8_t full = 2;
}  // namespace trust

/// Full trust: object pixels at least erode_px inside the stencil (the photo's own border does not count as
/// background); near: within fill_px of one. An empty stencil trusts every pixel.
[[nodiscard]] Image8 usable_pixels(const Image8& stencil_or_empty, int width, int height, double erode_px,
                                   double fill_px);

}  // namespace drape::texturing
