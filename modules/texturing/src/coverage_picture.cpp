#include "coverage_picture.hpp"

#include <algorithm>
#include <cmath>

#include "usable_pixels.hpp"

namespace drape::texturing {
namespace {

void cover(const PixelTriangle& t, Image8& covered) {
  const auto [left, right] = std::minmax({t[0].x(), t[1].x(), t[2].x()});
  const auto [top, bottom] = std::minmax({t[0].y(), t[1].y(), t[2].y()});
  const auto pixel = [](double v, int size) {
    return std::clamp(static_cast<int>(std::floor(v)), 0, size - 1);
  };
  const auto beyond = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
    return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
  };
  bool any = false;
  for (int y = pixel(top, covered.height()); y <= pixel(bottom, covered.height()); ++y)
    for (int x = pixel(left, covered.width()); x <= pixel(right, covered.width()); ++x) {
      const Eigen::Vector2d center(x + 0.5, y + 0.5);
      const std::array<double, 3> side = {beyond(t[0], t[1], center), beyond(t[1], t[2], center),
                                          beyond(t[2], t[0], center)};
      const auto [least, most] = std::minmax({side[0], side[1], side[2]});
      if (least < 0 && most > 0) continue;
      covered.at(x, y) = 1;
      any = true;
    }
  if (any) return;
  const Eigen::Vector2d middle = (t[0] + t[1] + t[2]) / 3;
  covered.at(pixel(middle.x(), covered.width()), pixel(middle.y(), covered.height())) = 1;
}

}  // namespace

Image8 covered_pixels(const std::vector<PixelTriangle>& triangles, int width, int height) {
  Image8 covered(width, height, 1, 0);
  for (const PixelTriangle& t : triangles) cover(t, covered);
  return covered;
}

Image8 coverage_picture(const Image8& rgb, const Image8& covered, const Image8& trusted) {
  constexpr std::array<int, 3> orange = {255, 140, 0};
  Image8 picture(rgb.width(), rgb.height(), 3);
  for (int y = 0; y < rgb.height(); ++y)
    for (int x = 0; x < rgb.width(); ++x) {
      const std::uint8_t* in = &rgb.at(x, y);
      std::uint8_t* out = &picture.at(x, y);
      const int dim = (3 * (in[0] + 2 * in[1] + in[2]) + 20) / 40;  // 0.3 of the grey, rounded
      for (std::size_t c = 0; c < 3; ++c)
        if (covered.at(x, y) == 0)
          out[c] = static_cast<std::uint8_t>(dim);
        else if (trusted.at(x, y) == trust::full)
          out[c] = in[c];
        else
          out[c] = static_cast<std::uint8_t>((2 * in[c] + 3 * orange[c] + 2) / 5);  // 0.4 and 0.6
    }
  return picture;
}

}  // namespace drape::texturing
