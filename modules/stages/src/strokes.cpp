#include "strokes.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace drape::stages {
namespace {

double distance_to_segment(const Eigen::Vector2d& x, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double length = along.squaredNorm();
  const double share = length > 0 ? std::clamp((x - a).dot(along) / length, 0.0, 1.0) : 0.0;
  return (x - a - share * along).norm();
}

}  // namespace

void draw_line(Image8& picture, const std::vector<std::array<double, 2>>& points_px, double width_px,
               std::uint8_t value) {
  // A thin line still marks the pixels that it runs through.
  const double reach = std::max(width_px / 2, 0.75);
  for (std::size_t i = 0; i < points_px.size(); ++i) {
    const auto& from = points_px[i];
    const auto& to = points_px[std::min(i + 1, points_px.size() - 1)];
    const Eigen::Vector2d a(from[0], from[1]);
    const Eigen::Vector2d b(to[0], to[1]);
    const auto first = [&](double low, int most) {
      return static_cast<int>(std::clamp(std::floor(low - reach), 0.0, static_cast<double>(most)));
    };
    const auto last = [&](double high, int most) {
      return static_cast<int>(std::clamp(std::ceil(high + reach), 0.0, static_cast<double>(most)));
    };
    const int right = last(std::max(a.x(), b.x()), picture.width());
    const int bottom = last(std::max(a.y(), b.y()), picture.height());
    for (int y = first(std::min(a.y(), b.y()), picture.height()); y < bottom; ++y)
      for (int x = first(std::min(a.x(), b.x()), picture.width()); x < right; ++x)
        if (distance_to_segment({x + 0.5, y + 0.5}, a, b) <= reach) picture.at(x, y) = value;
  }
}

}  // namespace drape::stages
