// A piece of a photo in which the object's colours go on where the photo shows something else.
#pragma once

#include "drape/geometry/deep_image.hpp"

namespace drape::texturing {

/// Pixels left <= x < right, top <= y < bottom of a photo.
struct PixelBox {
  int left = 0;
  int top = 0;
  int right = 0;
  int bottom = 0;
  [[nodiscard]] int width() const { return right - left; }
  [[nodiscard]] int height() const { return bottom - top; }
};

/// What a model is painted with: `deep`, where that is asked for and the photo has it.
struct PhotoPixels {
  const Image8* rgb = nullptr;
  const Image16* deep = nullptr;  // null or empty: it has none
  bool paint_deep = false;        // in 16 bits a channel
};

/// Fully trusted pixels keep their bytes; all others get colours grown from them, in linear light: pull-push
/// (Gortler, Grzeszczuk, Szeliski, Cohen, "The Lumigraph", SIGGRAPH 1996, section 3.4). Without a trusted
/// pixel in the box, the photo's own.
[[nodiscard]] Image8 grown_photo(const Image8& rgb, const Image8& trusted, const PixelBox& box);
/// The same in 16 bits, whether or not the photo has them.
[[nodiscard]] Image16 deep_grown_photo(const PhotoPixels& photo, const Image8& trusted, const PixelBox& box);

}  // namespace drape::texturing
