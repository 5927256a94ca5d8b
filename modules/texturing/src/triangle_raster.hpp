// The texels of a triangle.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

namespace drape::texturing {

/// Rows and columns first <= x < last that may be visited.
struct TexelBounds {
  int left;
  int top;
  int right;
  int bottom;
};

/// Calls visit(x, y, barycentric) for the texels whose centres lie in the triangle or up to `margin` texels
/// beyond its edges, row by row. Centres are at +0.5; the winding does not matter. Beyond the edges the
/// weights go on linearly (one is negative), but those of a triangle thinner than a texel stay within it. A
/// triangle without area has no texels.
template <class Visit>
void for_texels(const std::array<Eigen::Vector2d, 3>& t, double margin, const TexelBounds& bounds,
                Visit visit) {
  const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
  };
  const double twice_area = cross(t[1] - t[0], t[2] - t[0]);
  if (twice_area == 0 || !std::isfinite(twice_area)) return;
  std::array<double, 3> reach{};  // how negative a weight may be
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double length = (t[(k + 2) % 3] - t[(k + 1) % 3]).norm();
    reach[k] = margin * length / std::abs(twice_area);
    longest = std::max(longest, length);
  }
  const bool thin = std::abs(twice_area) < longest;
  const auto [least_x, most_x] = std::minmax({t[0].x(), t[1].x(), t[2].x()});
  const auto [least_y, most_y] = std::minmax({t[0].y(), t[1].y(), t[2].y()});
  const int left = std::max(bounds.left, static_cast<int>(std::ceil(least_x - margin - 0.5)));
  const int right = std::min(bounds.right - 1, static_cast<int>(std::floor(most_x + margin - 0.5)));
  const int top = std::max(bounds.top, static_cast<int>(std::ceil(least_y - margin - 0.5)));
  const int bottom = std::min(bounds.bottom - 1, static_cast<int>(std::floor(most_y + margin - 0.5)));
  for (int y = top; y <= bottom; ++y)
    for (int x = left; x <= right; ++x) {
      const Eigen::Vector2d p(x + 0.5, y + 0.5);
      Eigen::Vector3d weights(cross(t[1] - p, t[2] - p), cross(t[2] - p, t[0] - p),
                              cross(t[0] - p, t[1] - p));
      weights /= twice_area;
      if (weights[0] < -reach[0] || weights[1] < -reach[1] || weights[2] < -reach[2]) continue;
      if (thin) {
        weights = weights.cwiseMax(0.0);
        weights /= weights.sum();
      }
      visit(x, y, weights);
    }
}

}  // namespace drape::texturing
