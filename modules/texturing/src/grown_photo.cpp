#include "grown_photo.hpp"

#include <algorithm>

#include "pull_push.hpp"
#include "usable_pixels.hpp"

namespace drape::texturing {

namespace {

template <class Sample>
Image<Sample> piece_of(const Image<Sample>& rgb, const PixelBox& box) {
  Image<Sample> piece(box.width(), box.height(), 3);
  for (int y = 0; y < box.height(); ++y)
    std::copy_n(&rgb.at(box.left, box.top + y), 3 * box.width(), piece.row(y).begin());
  return piece;
}

template <class Sample>
Image<Sample> grown(Image<Sample> piece, const Image8& trusted, const PixelBox& box) {
  Image8 known(box.width(), box.height(), 1, 0);
  for (int y = 0; y < box.height(); ++y)
    for (int x = 0; x < box.width(); ++x)
      if (trusted.at(box.left + x, box.top + y) == trust::full) known.at(x, y) = 1;
  grow_colors(piece, known);
  return piece;
}

}  // namespace

Image8 grown_photo(const Image8& rgb, const Image8& trusted, const PixelBox& box) {
  return grown(piece_of(rgb, box), trusted, box);
}

Image16 deep_grown_photo(const PhotoPixels& photo, const Image8& trusted, const PixelBox& box) {
  const bool deep = photo.deep != nullptr && !photo.deep->empty();
  return grown(deep ? piece_of(*photo.deep, box) : deep_from_bytes(piece_of(*photo.rgb, box)), trusted, box);
}

}  // namespace drape::texturing
