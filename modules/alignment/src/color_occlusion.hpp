// What hides the object in the photo.
#pragma once

#include "color_level.hpp"
#include "drape/geometry/image.hpp"
#include "outline_drawing.hpp"

namespace drape::alignment {

/// Pixels of the level's window inside the drawn outline that have the surroundings' colours rather than the
/// object's, and hang together with the rim: 1 there, else 0. Spots of the object itself that look like the
/// surroundings are not told apart from what hides it, where they reach the rim.
[[nodiscard]] Image8 hidden_pixels(const ColorLevel& level, const OutlineDrawing& drawing);

}  // namespace drape::alignment
