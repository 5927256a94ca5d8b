// The shadow that an object casts on its backdrop.
#pragma once

#include "drape/geometry/image.hpp"
#include "lab_image.hpp"

namespace drape::segmentation {

/// Pixels (1, else 0) that may be the backdrop in shadow: `darker` (1: darker than the backdrop there and of
/// its tint) and hanging together with `backdrop` (1: as bright as it) without a step of lightness. A
/// shadow's rim is soft somewhere, as lamps and windows have a size, while an object ends in a step; a part
/// of the object of the backdrop's own tint, seen without a step, cannot be told from a shadow.
[[nodiscard]] Image8 cast_shadow(const ImageF& lab, const Image8& backdrop, const Image8& darker);

}  // namespace drape::segmentation
