#include "point_raster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "color.hpp"

namespace drape::report {
namespace {

constexpr float nothing = std::numeric_limits<float>::infinity();
constexpr float shading_strength = 60.0F;

}  // namespace

PointRaster::PointRaster(const Camera& camera)
    : camera_(camera),
      focal_px_(std::sqrt(std::abs(camera.K.topLeftCorner<2, 2>().determinant()))),
      depth_(camera.width, camera.height, 1, nothing),
      light_(camera.width, camera.height, 1, Eigen::Vector3f::Zero()) {}

void PointRaster::draw(const Eigen::Vector3d& point_in_world, double diameter_in_world,
                       const Eigen::Vector3f& light) {
  const Camera::Projected projected = camera_.project(point_in_world);
  if (!(projected.depth > 0) || !projected.pixel.allFinite()) return;
  const double u = projected.pixel.x();
  const double v = projected.pixel.y();
  if (u < -1e6 || v < -1e6 || u > 1e6 || v > 1e6) return;
  const double radius = diameter_in_world * focal_px_ / projected.depth / 2;
  const int reach = std::min(static_cast<int>(std::ceil(radius)), 64);
  const auto depth = static_cast<float>(projected.depth);
  const int center_x = static_cast<int>(std::floor(u));
  const int center_y = static_cast<int>(std::floor(v));
  for (int y = center_y - reach; y <= center_y + reach; ++y)
    for (int x = center_x - reach; x <= center_x + reach; ++x) {
      if (!depth_.contains(x, y) || depth >= depth_.at(x, y)) continue;
      const bool on_center = x == center_x && y == center_y;
      if (!on_center && std::hypot(x + 0.5 - u, y + 0.5 - v) > radius) continue;
      depth_.at(x, y) = depth;
      light_.at(x, y) = light;
    }
}

float PointRaster::shading(int x, int y) const {
  // Boucheny 2009, section 3.3: a pixel is darker the more its neighbours stand out in front of it; the
  // logarithm makes the answer the same at any scale.
  static constexpr std::array<std::array<int, 2>, 8> around = {
      {{2, 0}, {-2, 0}, {0, 2}, {0, -2}, {3, 3}, {-3, 3}, {3, -3}, {-3, -3}}};
  const float here = std::log2(depth_.at(x, y));
  float sum = 0;
  for (const auto& [dx, dy] : around)
    if (depth_.contains(x + dx, y + dy) && depth_.at(x + dx, y + dy) < nothing)
      sum += std::max(0.0F, here - std::log2(depth_.at(x + dx, y + dy)));
  return std::exp(-shading_strength * sum / static_cast<float>(around.size()));
}

Image8 PointRaster::picture(const Eigen::Vector3f& background) const {
  Image8 image(depth_.width(), depth_.height(), 3);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const bool seen = depth_.at(x, y) < nothing;
      const float shade = seen ? shading(x, y) : 1.0F;
      for (int c = 0; c < 3; ++c)
        image.at(x, y, c) =
            seen ? byte_from_linear(shade * light_.at(x, y)[c]) : byte_from_unit(background[c]);
    }
  return image;
}

}  // namespace drape::report
