#include "photo_colors.hpp"

#include <algorithm>
#include <array>
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

// Where a position lies between the centres of a picture's pixels, which it is kept within.
struct Between {
  int x;
  int y;
  float right;  // of pixel (x, y)
  float below;
};
Between between(const Eigen::Vector2d& place, int width, int height) {
  const double px = std::clamp(place.x() - 0.5, 0.0, width - 1.0);
  const double py = std::clamp(place.y() - 0.5, 0.0, height - 1.0);
  const int x = static_cast<int>(px);
  const int y = static_cast<int>(py);
  return {x, y, static_cast<float>(px - x), static_cast<float>(py - y)};
}

template <class Sample>
Eigen::Vector3f linear_at(const Image<Sample>& rgb, int x, int y) {
  x = std::clamp(x, 0, rgb.width() - 1);
  y = std::clamp(y, 0, rgb.height() - 1);
  return {linear_from(rgb.at(x, y, 0)), linear_from(rgb.at(x, y, 1)), linear_from(rgb.at(x, y, 2))};
}

template <class Sample>
Eigen::Vector3f bilinear(const Image<Sample>& rgb, const Eigen::Vector2d& place) {
  const auto [x, y, right, below] = between(place, rgb.width(), rgb.height());
  return (1 - below) * ((1 - right) * linear_at(rgb, x, y) + right * linear_at(rgb, x + 1, y)) +
         below * ((1 - right) * linear_at(rgb, x, y + 1) + right * linear_at(rgb, x + 1, y + 1));
}

// Weights of the four pixels round a place `t` beyond the second (Keys, "Cubic convolution interpolation for
// digital image processing", 1981, with a = -1/2).
std::array<float, 4> cubic_weights(float t) {
  const float t2 = t * t;
  const float t3 = t2 * t;
  return {(-t3 + 2 * t2 - t) / 2, (3 * t3 - 5 * t2 + 2) / 2, (-3 * t3 + 4 * t2 + t) / 2, (t3 - t2) / 2};
}

template <class Sample>
Eigen::Vector3f cubic(const Image<Sample>& rgb, const Eigen::Vector2d& place) {
  const Between at = between(place, rgb.width(), rgb.height());
  const std::array<float, 4> across = cubic_weights(at.right);
  const std::array<float, 4> down = cubic_weights(at.below);
  Eigen::Vector3f color = Eigen::Vector3f::Zero();
  for (int j = 0; j < 4; ++j) {
    Eigen::Vector3f row = Eigen::Vector3f::Zero();
    for (int i = 0; i < 4; ++i)
      row += across[static_cast<std::size_t>(i)] * linear_at(rgb, at.x + i - 1, at.y + j - 1);
    color += down[static_cast<std::size_t>(j)] * row;
  }
  return color.cwiseMax(0.F).cwiseMin(1.F);
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

Eigen::Vector2d PhotoColors::in_box(const Eigen::Vector2d& pixel) const {
  return pixel - Eigen::Vector2d(box_.left, box_.top);
}

Eigen::Vector3f PhotoColors::at(const Eigen::Vector2d& pixel) const {
  return deep_grown_.empty() ? cubic(grown_, in_box(pixel)) : cubic(deep_grown_, in_box(pixel));
}

// A mean needs no sharper reading.
Eigen::Vector3f PhotoColors::quickly_at(const Eigen::Vector2d& pixel) const {
  return deep_grown_.empty() ? bilinear(grown_, in_box(pixel)) : bilinear(deep_grown_, in_box(pixel));
}

Eigen::Vector3f PhotoColors::smooth_at(const Eigen::Vector2d& pixel) const {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) sum += quickly_at(pixel + Eigen::Vector2d(dx, dy));
  return sum / 9;
}

float PhotoColors::contrast_at(const Eigen::Vector2d& pixel) const {
  Eigen::Array3f sum = Eigen::Array3f::Zero();
  Eigen::Array3f squares = Eigen::Array3f::Zero();
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const Eigen::Array3f log = log_light(quickly_at(pixel + Eigen::Vector2d(dx, dy))).array();
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
