// Depth of OpenEXR pictures.
#pragma once

#include <string>
#include <string_view>

#include "drape/geometry/image.hpp"

namespace drape::io {

[[nodiscard]] bool looks_like_exr(std::string_view bytes);

/// The picture's only channel, else the one named Z, V, Y or R, the first of these (also in a layer, as
/// "View.Depth.Z"): half floats or floats; 0 where there is no depth (not a number, infinite, 1e10 and more).
/// The data window is the picture. Error{input} for whole numbers, several unnamed channels, more than 2^28
/// pixels, a truncated or damaged file.
[[nodiscard]] ImageF decode_exr_depth(const std::string& file, std::string_view bytes);

}  // namespace drape::io
