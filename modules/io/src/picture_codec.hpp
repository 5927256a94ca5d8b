// Pixels from and to the bytes of picture files, by OpenCV.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "drape/geometry/deep_image.hpp"

namespace drape::io {

struct DecodedPicture {
  Image8 pixels;                     // 1 grey, 3 RGB or 4 RGBA; 16 bit reduced to 8; as stored, not turned
  bool only_zeros_and_ones = false;  // in the file's own depth: a mask of labels
  Image16 deep_rgb;                  // of a picture of 16 bit, grey spread, if asked for; else empty
};

/// Error{input} if the bytes are no whole picture or hold samples that are not whole numbers of 8 or 16 bits.
[[nodiscard]] DecodedPicture decode_picture(const std::string& file, std::string_view bytes,
                                            bool keep_depth = false);

/// A picture of one channel of 16-bit whole numbers or floats, in its own numbers. Error{input} for any
/// other.
[[nodiscard]] ImageF decode_depth(const std::string& file, std::string_view bytes);

}  // namespace drape::io
