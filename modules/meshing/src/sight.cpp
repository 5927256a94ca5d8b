#include "sight.hpp"

#include <algorithm>
#include <cmath>

namespace drape::meshing {
namespace {

using Eigen::Vector3d;

// A frame whose z axis is `axis`.
Eigen::Matrix3d looking_along(const Vector3d& axis) {
  const Vector3d right = axis.unitOrthogonal();
  Eigen::Matrix3d rotation;
  rotation << right.transpose(), axis.cross(right).transpose(), axis.transpose();
  return rotation;
}

Rigid3 frame(const Eigen::Matrix3d& sight_from_scan, const Vector3d& origin_in_scan,
             const Rigid3& world_from_scan) {
  Rigid3 in_scan = Rigid3::Identity();
  in_scan.linear() = sight_from_scan;
  in_scan.translation() = -(sight_from_scan * origin_in_scan);
  return in_scan * world_from_scan.inverse();
}

// The mean of the finite points, and of the unit vectors from an origin to them.
struct Means {
  std::size_t count = 0;
  Vector3d point = Vector3d::Zero();
  Vector3d ray = Vector3d::Zero();
};

Means means_of(const PointCloud& cloud, const Vector3d& origin) {
  Means means;
  for (const Vector3d& p : cloud.positions) {
    if (!p.allFinite() || p == origin) continue;
    ++means.count;
    means.point += p;
    means.ray += (p - origin).normalized();
  }
  if (means.count > 0) means.point /= static_cast<double>(means.count);
  return means;
}

Vector3d mean_normal(const PointCloud& cloud) {
  Vector3d sum = Vector3d::Zero();
  for (const Eigen::Vector3f& n : cloud.normals)
    if (n.allFinite()) sum += n.cast<double>();
  return sum;
}

double median_range(const PointCloud& cloud, const Vector3d& origin) {
  std::vector<double> ranges;
  for (const Vector3d& p : cloud.positions)
    if (p.allFinite()) ranges.push_back((p - origin).norm());
  const auto middle = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() / 2);
  std::nth_element(ranges.begin(), middle, ranges.end());
  return *middle;
}

// Whether all of the cloud is seen from `origin` within 60 degrees of `axis`.
bool within_cone(const PointCloud& cloud, const Vector3d& origin, const Vector3d& axis) {
  return std::all_of(cloud.positions.begin(), cloud.positions.end(), [&](const Vector3d& p) {
    return !p.allFinite() || (p - origin).dot(axis) >= 0.5 * (p - origin).norm();
  });
}

std::vector<Sight> parallel_sight(const Vector3d& direction, const Vector3d& middle,
                                  const Rigid3& world_from_scan, double spacing, double pixel_spacings) {
  Sight sight;
  sight.sight_from_world = frame(looking_along(direction), middle, world_from_scan);
  sight.pitch = pixel_spacings * spacing;
  sight.pixels_per_spacing = 1 / pixel_spacings;
  return {sight};
}

}  // namespace

std::vector<Sight> sights_of(const RangeScan& scan, const Rigid3& world_from_scan, double spacing,
                             double pixel_spacings) {
  const Vector3d origin = scan.view.vector;
  const Means means = means_of(scan.cloud, origin);
  if (means.count == 0) return {};
  if (scan.view.kind == ScanView::Kind::direction)
    return parallel_sight(scan.view.vector.normalized(), means.point, world_from_scan, spacing,
                          pixel_spacings);
  if (scan.view.kind == ScanView::Kind::unknown) {
    const Vector3d normal = mean_normal(scan.cloud);
    if (!scan.grid || !(normal.norm() > 0)) return {};
    return parallel_sight(-normal.normalized(), means.point, world_from_scan, spacing, pixel_spacings);
  }
  Sight sight;
  sight.parallel = false;
  sight.pitch = pixel_spacings * spacing / median_range(scan.cloud, origin);
  sight.pixels_per_spacing = 1 / pixel_spacings;
  const Vector3d axis = means.ray.stableNormalized();
  if (within_cone(scan.cloud, origin, axis)) {
    sight.sight_from_world = frame(looking_along(axis), origin, world_from_scan);
    return {sight};
  }
  // A little more than a side of the cube, so that no gap is left between them.
  constexpr double margin_pixels = 8;
  sight.widest_tangent = 1 + margin_pixels * sight.pitch;
  std::vector<Sight> sides;
  for (int k = 0; k < 3; ++k)
    for (const double sign : {1.0, -1.0}) {
      sides.push_back(sight);
      sides.back().sight_from_world = frame(looking_along(sign * Vector3d::Unit(k)), origin, world_from_scan);
    }
  return sides;
}

}  // namespace drape::meshing
