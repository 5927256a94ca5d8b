#include "drape/rendering/shadow_map.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace drape::rendering {
namespace {

constexpr double offset_texels = 2;

Camera camera_along(const BoundingBox& box, const Eigen::Vector3d& towards_light, int side) {
  const double radius = std::max(box.diagonal().norm() / 2, 1e-12);
  Camera camera = look_at(box.center() + 2 * radius * towards_light, box.center(),
                          towards_light.unitOrthogonal(), side, side, 60);
  camera.projection = Camera::Projection::orthographic;
  // A margin of two texels, so that what lies on the border has all its neighbours.
  const double scale = (side - 4) / (2 * radius);
  camera.K << scale, 0, side / 2.0, 0, scale, side / 2.0, 0, 0, 1;
  return camera;
}

}  // namespace

ShadowMap::ShadowMap(Renderer& renderer, const BoundingBox& box, const Eigen::Vector3d& towards_light,
                     int side)
    : camera_(camera_along(box, towards_light, side)),
      texel_(1 / camera_.K(0, 0)),
      depth_(renderer.depth_map(camera_).depth) {
  const Eigen::Matrix4d camera_from_world = camera_.camera_from_world.matrix();
  local_from_world_.row(0) =
      camera_.K(0, 0) * camera_from_world.row(0) + Eigen::RowVector4d(0, 0, 0, camera_.K(0, 2) - 0.5);
  local_from_world_.row(1) =
      camera_.K(1, 1) * camera_from_world.row(1) + Eigen::RowVector4d(0, 0, 0, camera_.K(1, 2) - 0.5);
  local_from_world_.row(2) = camera_from_world.row(2);
}

float ShadowMap::lit(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const {
  const Eigen::Vector3d at = local_from_world_ * (point + offset_texels * texel_ * normal).homogeneous();
  const double px = std::clamp(at.x(), 0.0, depth_.width() - 1.001);
  const double py = std::clamp(at.y(), 0.0, depth_.height() - 1.001);
  const int x = static_cast<int>(px);
  const int y = static_cast<int>(py);
  const auto fx = static_cast<float>(px - x);
  const auto fy = static_cast<float>(py - y);
  const auto passes = [&](int column, int row) { return depth_.at(column, row) >= at.z() ? 1.F : 0.F; };
  return (1 - fy) * ((1 - fx) * passes(x, y) + fx * passes(x + 1, y)) +
         fy * ((1 - fx) * passes(x, y + 1) + fx * passes(x + 1, y + 1));
}

SoftShadow::SoftShadow(Renderer& renderer, const BoundingBox& box, const Eigen::Vector3d& towards_light,
                       double radius_rad, int maps, int side) {
  const Eigen::Vector3d u = towards_light.unitOrthogonal();
  const Eigen::Vector3d v = towards_light.cross(u);
  // Vogel's spiral spreads any number of points evenly over a disc.
  for (int i = 0; i < maps; ++i) {
    const double r = maps == 1 ? 0 : std::tan(radius_rad) * std::sqrt((i + 0.5) / maps);
    const double around = 2 * std::numbers::pi * (std::numbers::phi - 1) * i;
    maps_.emplace_back(renderer, box,
                       (towards_light + r * (std::cos(around) * u + std::sin(around) * v)).normalized(),
                       side);
  }
}

float SoftShadow::lit(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const {
  float sum = 0;
  for (const ShadowMap& map : maps_) sum += map.lit(point, normal);
  return sum / static_cast<float>(maps_.size());
}

}  // namespace drape::rendering
