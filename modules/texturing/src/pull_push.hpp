// Colours where there are none, from those around.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "drape/geometry/deep_image.hpp"

namespace drape::texturing {

/// width x height pixels from the top; linear colour times its weight, and the weight (0..1).
struct WeightedPixels {
  int width = 0;
  int height = 0;
  std::vector<Eigen::Vector4f> pixels;

  WeightedPixels(int w, int h)
      : width(w),
        height(h),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), Eigen::Vector4f::Zero()) {}
  Eigen::Vector4f& at(int x, int y) { return pixels[index(x, y)]; }
  [[nodiscard]] const Eigen::Vector4f& at(int x, int y) const { return pixels[index(x, y)]; }
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

/// Every pixel gets weight 1: those that have it stay as they are, the others are filled from coarser and
/// coarser means (Gortler, Grzeszczuk, Szeliski, Cohen, "The Lumigraph", SIGGRAPH 1996, section 3.4). Without
/// any weight, as it was.
[[nodiscard]] WeightedPixels pull_pushed(WeightedPixels pixels);

/// The same for a picture (RGB, sRGB-encoded, of the size of `known`), filled where `known` is 0;
/// the first pixels beside what is known continue their neighbours.
template <class Sample>
void grow_colors(Image<Sample>& rgb, const Image8& known);
extern template void grow_colors(Image8& rgb, const Image8& known);
extern template void grow_colors(Image16& rgb, const Image8& known);

}  // namespace drape::texturing
