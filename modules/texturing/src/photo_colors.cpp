#include "photo_colors.hpp"

#include <algorithm>
#include <cmath>

#include "area_prefilter.hpp"
#include "linear_light.hpp"
#include "usable_pixels.hpp"

namespace drape::texturing {
namespace {

constexpr int margin_px = 8;

PixelBox usable_box(const Image8& trusted) {
  PixelBox box{trusted.width(), trusted.height(), 0, 0};
  for (int y = 0; y < trusted.height(); ++y)
    for (int x = 0; x < trusted.width(); ++x) {
      if (trusted.at(x, y) == trust::none) continue;
      box = {std::min(box.left, x), std::min(box.top, y), std::max(box.right, x + 1),
             std::max(box.bottom, y + 1)};
    }
  if (box.right <= box.left) return {0, 0, 1, 1};
  return {std::max(0, box.left - margin_px), std::max(0, box.top - margin_px),
          std::min(trusted.width(), box.right + margin_px),
          std::min(trusted.height(), box.bottom + margin_px)};
}

// Linear light between the four pixels round a position, which is kept within the picture.
template <class Sample>
Eigen::Vector3f between(const Image<Sample>& rgb, const Eigen::Vector2d& place) {
  const double px = std::clamp(place.x() - 0.5, 0.0, rgb.width() - 1.0);
  const double py = std::clamp(place.y() - 0.5, 0.0, rgb.height() - 1.0);
  const int x = static_cast<int>(px);
  const int y = static_cast<int>(py);
  const int right = std::min(x + 1, rgb.width() - 1);
  const int below = std::min(y + 1, rgb.height() - 1);
  const auto fx = static_cast<float>(px - x);
  const auto fy = static_cast<float>(py - y);
  Eigen::Vector3f color;
  for (int c = 0; c < 3; ++c) {
    const float over = (1 - fx) * linear_from(rgb.at(x, y, c)) + fx * linear_from(rgb.at(right, y, c));
    const float under =
        (1 - fx) * linear_from(rgb.at(x, below, c)) + fx * linear_from(rgb.at(right, below, c));
    color[c] = (1 - fy) * over + fy * under;
  }
  return color;
}

}  // namespace

PhotoColors::PhotoColors(const PhotoPixels& photo, const Image8& trusted) : box_(usable_box(trusted)) {
  if (photo.paint_deep) {
    deep_grown_ = deep_grown_photo(photo, trusted, box_);
    prefilter_areas(deep_grown_);
  } else {
    grown_ = grown_photo(*photo.rgb, trusted, box_);
    prefilter_areas(grown_);
  }
}

Eigen::Vector3f PhotoColors::at(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d place = pixel - Eigen::Vector2d(box_.left, box_.top);
  return deep_grown_.empty() ? between(grown_, place) : between(deep_grown_, place);
}

Eigen::Vector3f PhotoColors::smooth_at(const Eigen::Vector2d& pixel) const {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) sum += at(pixel + Eigen::Vector2d(dx, dy));
  return sum / 9;
}

float PhotoColors::contrast_at(const Eigen::Vector2d& pixel) const {
  Eigen::Array3f sum = Eigen::Array3f::Zero();
  Eigen::Array3f squares = Eigen::Array3f::Zero();
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const Eigen::Array3f log = log_light(at(pixel + Eigen::Vector2d(dx, dy))).array();
      sum += log;
      squares += log.square();
    }
  return (squares / 9 - (sum / 9).square()).max(0.F).sqrt().mean();
}

Eigen::Vector3f log_light(const Eigen::Vector3f& linear) {
  constexpr float floor = 0.01F;
  return (linear.cwiseMax(0.F).array() + floor).log();
}

}  // namespace drape::texturing
