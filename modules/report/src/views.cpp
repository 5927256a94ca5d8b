#include "drape/report/views.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "drape/base/error.hpp"
#include "drape/geometry/bounding_box.hpp"

namespace drape::report {
namespace {

constexpr double deg = std::numbers::pi / 180;
constexpr double first_fov_deg = 24;  // a long lens: little distortion, and still some depth

void require_usable(const ViewStyle& style) {
  if (style.views <= 0 || style.width_px <= 0 || style.height_px <= 0)
    throw input_error("cannot look from {} sides in pictures of {} x {} pixels", style.views, style.width_px,
                      style.height_px);
  if (!style.up.allFinite() || !(style.up.norm() > 0))
    throw input_error("the direction that points up has no length");
  if (!(std::abs(style.elevation_deg) <= 89))
    throw input_error("cannot look from an elevation of {} degrees: at most 89", style.elevation_deg);
}

// Across `up`, towards the first camera.
Eigen::Vector3d first_side(const ViewStyle& style) {
  const Eigen::Vector3d up = style.up.normalized();
  const Eigen::Vector3d level = style.front - style.front.dot(up) * up;
  if (level.allFinite() && level.norm() > 1e-6 * style.front.norm() && level.norm() > 0)
    return level.normalized();
  // -y for z up and z for y up, the usual fronts.
  const Eigen::Vector3d usual = std::abs(up.y()) > 0.9 ? Eigen::Vector3d(0, 0, 1) : Eigen::Vector3d(0, -1, 0);
  return (usual - usual.dot(up) * up).normalized();
}

double radius_about(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& center) {
  double squared = 0;
  for (const Eigen::Vector3d& point : points)
    if (point.allFinite()) squared = std::max(squared, (point - center).squaredNorm());
  return std::sqrt(squared);
}

// How far the points reach from the middle of the picture, as a share of half its size.
double reach(std::span<const Eigen::Vector3d> points, const Camera& camera) {
  const Eigen::Array2d half(camera.width / 2.0, camera.height / 2.0);
  double most = 0;
  for (const Eigen::Vector3d& point : points)
    if (point.allFinite())
      most = std::max(most, ((camera.project(point).pixel.array() - half).abs() / half).maxCoeff());
  return most;
}

}  // namespace

std::vector<Camera> cameras_around(std::span<const Eigen::Vector3d> points, const ViewStyle& style) {
  require_usable(style);
  const BoundingBox box = bounding_box(points);
  if (box.isEmpty()) return {};
  const Eigen::Vector3d center = box.center();
  const double radius = std::max(radius_about(points, center), 1e-7 * std::max(1.0, center.norm()));
  const double distance = radius / std::sin(first_fov_deg * deg / 2);
  const Eigen::Vector3d up = style.up.normalized();
  const Eigen::Vector3d first = first_side(style);

  std::vector<Camera> cameras;
  double most = 0;
  for (int i = 0; i < style.views; ++i) {
    const Eigen::AngleAxisd turn(2 * std::numbers::pi * i / style.views, up);
    const Eigen::Vector3d towards =
        std::cos(style.elevation_deg * deg) * (turn * first) + std::sin(style.elevation_deg * deg) * up;
    cameras.push_back(
        look_at(center + distance * towards, center, up, style.width_px, style.height_px, first_fov_deg));
    most = std::max(most, reach(points, cameras.back()));
  }
  if (most > 1e-6)  // less is rounding: all points are in one place
    for (Camera& camera : cameras) camera.K.topLeftCorner<2, 2>() *= style.filled_percent / 100 / most;
  return cameras;
}

}  // namespace drape::report
