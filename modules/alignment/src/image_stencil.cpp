#include "image_stencil.hpp"

#include <algorithm>
#include <cmath>

#include "drape/base/error.hpp"

namespace drape::alignment {
namespace {

Image8 resampled(const Image8& given, int longest_px) {
  const double factor =
      std::min(1.0, static_cast<double>(longest_px) / std::max(given.width(), given.height()));
  const int width = std::max(1, static_cast<int>(std::lround(given.width() * factor)));
  const int height = std::max(1, static_cast<int>(std::lround(given.height() * factor)));
  Image8 small(width, height, 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      small.at(x, y) = given.at(static_cast<int>((x + 0.5) * given.width() / width),
                                static_cast<int>((y + 0.5) * given.height() / height));
  return small;
}

}  // namespace

void check_stencil(const Image8& given) {
  if (given.empty() || given.channels() != 1)
    throw input_error("the stencil has {} x {} pixels of {} channels; it must have one channel",
                      given.width(), given.height(), given.channels());
  bool object = false;
  bool background = false;
  for (const std::uint8_t value : given.data()) {
    if (value != stencil::object && value != stencil::background && value != stencil::unknown)
      throw input_error(
          "the stencil holds the value {}; it must be {} (object), {} (background) or {} (unknown)", value,
          stencil::object, stencil::background, stencil::unknown);
    object |= value == stencil::object;
    background |= value == stencil::background;
  }
  if (!object) throw input_error("the stencil shows no object: none of its pixels is {}", stencil::object);
  if (!background)
    throw input_error("the stencil has no background, so that nothing bounds the object in the photo");
}

ImageStencil image_stencil(const Image8& photo_stencil, int longest_px) {
  check_stencil(photo_stencil);
  ImageStencil image;
  image.pixels = resampled(photo_stencil, longest_px);
  image.known = Image8(image.pixels.width(), image.pixels.height(), 1, 1);
  image.box_left = image.pixels.width();
  image.box_top = image.pixels.height();
  image.box_right = image.box_bottom = -1;
  for (int y = 0; y < image.pixels.height(); ++y)
    for (int x = 0; x < image.pixels.width(); ++x) {
      if (image.pixels.at(x, y) == stencil::unknown) image.known.at(x, y) = 0;
      if (image.pixels.at(x, y) != stencil::object) continue;
      image.box_left = std::min(image.box_left, x);
      image.box_right = std::max(image.box_right, x);
      image.box_top = std::min(image.box_top, y);
      image.box_bottom = std::max(image.box_bottom, y);
    }
  image.moments = moments_of(image.pixels, image.known);
  if (!(image.moments.deviation.minCoeff() > 0))
    throw input_error(
        "the object in the stencil is too small: at {} x {} pixels, at which stencils are compared, it is {} "
        "wide "
        "and {} high, and must be 2 each way at least",
        image.pixels.width(), image.pixels.height(), std::max(0, image.box_right - image.box_left + 1),
        std::max(0, image.box_bottom - image.box_top + 1));
  return image;
}

}  // namespace drape::alignment
