// Where in a photo a stencil says that the object is.
#pragma once

#include <array>
#include <optional>

#include "drape/geometry/image.hpp"

namespace drape::alignment {

/// x, y, width and height in photo pixels of a box round the largest connected part of a stencil, with some
/// room and within the photo: a stencil that is wrong in shape, as one with the plinth, still tells where the
/// object is. Nothing where no pixel is the object.
[[nodiscard]] std::optional<std::array<double, 4>> object_box(const Image8& stencil);

}  // namespace drape::alignment
