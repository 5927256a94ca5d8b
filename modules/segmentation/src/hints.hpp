// What the user said of a photo, in pixels of the picture at hand.
#pragma once

#include <array>
#include <optional>

#include "drape/geometry/image.hpp"

namespace drape::segmentation {

/// All clipped to the picture.
struct Hints {
  std::optional<std::array<int, 4>> box;    // left, top, right, bottom; the last two exclusive
  std::optional<std::array<int, 2>> click;  // x, y
  Image8 scribbles;                         // stencil::object, background, else unknown; or empty
};

}  // namespace drape::segmentation
