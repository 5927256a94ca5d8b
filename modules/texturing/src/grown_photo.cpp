#include "grown_photo.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <utility>

#include "linear_light.hpp"
#include "pull_push.hpp"
#include "usable_pixels.hpp"

namespace drape::texturing {

Image8 grown_photo(const Image8& rgb, const Image8& trusted, const PixelBox& box) {
  Image8 grown(box.width(), box.height(), 3);
  WeightedPixels pixels(box.width(), box.height());
  bool complete = true;
  bool any = false;
  for (int y = 0; y < box.height(); ++y) {
    std::copy_n(&rgb.at(box.left, box.top + y), 3 * box.width(), grown.row(y).begin());
    for (int x = 0; x < box.width(); ++x) {
      if (trusted.at(box.left + x, box.top + y) != trust::full) {
        complete = false;
        continue;
      }
      Eigen::Vector4f& p = pixels.at(x, y);
      for (int c = 0; c < 3; ++c) p[c] = linear_from_byte(grown.at(x, y, c));
      p.w() = 1;
      any = true;
    }
  }
  if (complete || !any) return grown;
  pixels = pull_pushed(std::move(pixels));
  for (int y = 0; y < box.height(); ++y)
    for (int x = 0; x < box.width(); ++x) {
      if (trusted.at(box.left + x, box.top + y) == trust::full) continue;
      for (int c = 0; c < 3; ++c) grown.at(x, y, c) = byte_from_linear(pixels.at(x, y)[c]);
    }
  return grown;
}

}  // namespace drape::texturing
