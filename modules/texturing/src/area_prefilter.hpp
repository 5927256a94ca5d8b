// Pixels are means over areas; texels are what goes between them.
#pragma once

#include "drape/geometry/deep_image.hpp"

namespace drape::texturing {

/// Takes out beforehand half of what blurs when a photo becomes a texture that bilinear filters draw (RGB,
/// sRGB-encoded; filtered in linear light, clamped to 0..1). Means over a pixel's area of what lies bilinear
/// between texels are 1/8, 3/4, 1/8 of three texels along each axis (the quadratic B-spline at whole
/// numbers); inverting 1/16, 7/8, 1/16 instead keeps the noise small. Two recursions do it (Unser, "Splines:
/// a perfect fit for signal and image processing", IEEE Signal Processing Magazine 1999, box 2); beyond the
/// border the picture is mirrored.
template <class Sample>
void prefilter_areas(Image<Sample>& rgb);
extern template void prefilter_areas(Image8& rgb);
extern template void prefilter_areas(Image16& rgb);

}  // namespace drape::texturing
