// CIE Lab pixels at a working size.
#pragma once

#include "drape/geometry/image.hpp"

namespace drape::segmentation {

using Labels = Image<std::int32_t>;

/// sRGB -> Lab (D65): L 0..100, a and b about -100..100. Same size, 3 channels.
[[nodiscard]] ImageF lab_image(const Image8& rgb);

/// Area-averaged so that its longer side is at most max_side; the same picture if it is smaller already.
[[nodiscard]] Image8 reduced(const Image8& rgb, int max_side);

/// Squared CIE76 colour difference of two pixels of a Lab image, or of any two triples.
[[nodiscard]] inline float squared_difference(const float* a, const float* b) {
  const float l = a[0] - b[0];
  const float u = a[1] - b[1];
  const float v = a[2] - b[2];
  return l * l + u * u + v * v;
}

}  // namespace drape::segmentation
