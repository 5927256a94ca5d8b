#include "grown_photo.hpp"

#include <algorithm>

#include "pull_push.hpp"
#include "usable_pixels.hpp"

namespace drape::texturing {

Image8 grown_photo(const Image8& rgb, const Image8& trusted, const PixelBox& box) {
  Image8 grown(box.width(), box.height(), 3);
  Image8 known(box.width(), box.height(), 1, 0);
  for (int y = 0; y < box.height(); ++y) {
    std::copy_n(&rgb.at(box.left, box.top + y), 3 * box.width(), grown.row(y).begin());
    for (int x = 0; x < box.width(); ++x)
      if (trusted.at(box.left + x, box.top + y) == trust::full) known.at(x, y) = 1;
  }
  grow_colors(grown, known);
  return grown;
}

}  // namespace drape::texturing
