// A scan's picture plane: where a point is seen, and how deep it lies.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "drape/geometry/range_scan.hpp"
#include "drape/geometry/rigid3.hpp"

namespace drape::meshing {

/// Pixel centres lie at whole columns and rows. A parallel sight looks along z of its frame; the others look
/// from their frame's origin, at most 60 degrees off z, and `depth` is along z, not along the ray.
struct Sight {
  Rigid3 sight_from_world = Rigid3::Identity();
  bool parallel = true;
  double pitch = 1;  // of a pixel: a length, or a tangent (at depth 1) where rays diverge
  double pixels_per_spacing = 1;
  double widest_tangent = 1.8;  // where rays diverge: what is farther off the axis is not in the picture
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();  // of pixel (0, 0), in the unit of `pitch`

  /// column, row, depth
  [[nodiscard]] Eigen::Vector3d picture_of(const Eigen::Vector3d& in_world) const {
    const Eigen::Vector3d q = sight_from_world * in_world;
    const double scale = parallel ? 1 : q.z();
    return {(q.x() / scale - corner.x()) / pitch, (q.y() / scale - corner.y()) / pitch, q.z()};
  }
  [[nodiscard]] Eigen::Vector3d in_sight(const Eigen::Vector3d& picture) const {
    const double scale = parallel ? 1 : picture.z();
    return {(picture.x() * pitch + corner.x()) * scale, (picture.y() * pitch + corner.y()) * scale,
            picture.z()};
  }
  /// Of a pixel at a depth.
  [[nodiscard]] double width_at(double depth) const { return parallel ? pitch : pitch * depth; }
  /// Of neighbouring samples at a depth.
  [[nodiscard]] double spacing_at(double depth) const { return width_at(depth) * pixels_per_spacing; }

  /// A normal, not of unit length, towards the scanner, in the sight's frame. The slopes are those of the
  /// depth against lengths across the sight at that depth. With it (depth of the surface - depth of a point
  /// on the same ray) / |normal| is the point's distance from the surface's tangent plane, positive in front.
  [[nodiscard]] Eigen::Vector3f normal_of(float column, float row, float slope_x, float slope_y) const {
    if (parallel) return {slope_x, slope_y, -1};
    const float u = column * static_cast<float>(pitch) + static_cast<float>(corner.x());
    const float v = row * static_cast<float>(pitch) + static_cast<float>(corner.y());
    return {slope_x, slope_y, -(1 + u * slope_x + v * slope_y)};
  }
  /// Cosine of the angle between that normal and the ray.
  [[nodiscard]] float incidence_cosine(float column, float row, float slope_x, float slope_y) const {
    const float length = normal_of(column, row, slope_x, slope_y).norm();
    if (parallel) return 1 / length;
    const float u = column * static_cast<float>(pitch) + static_cast<float>(corner.x());
    const float v = row * static_cast<float>(pitch) + static_cast<float>(corner.y());
    return 1 / (length * std::sqrt(1 + u * u + v * v));
  }
};

/// One sight for a scan of parallel rays or of a field of view within a cone; six, as the sides of a cube,
/// for a scanner that looks all around. A scan with a grid and normals but no view is looked at against its
/// mean normal. None where nothing is known, or no point is finite. `spacing` is the scan's; pixels are
/// `pixel_spacings` of it wide at the median depth. `corner` is not set.
[[nodiscard]] std::vector<Sight> sights_of(const RangeScan& scan, const Rigid3& world_from_scan,
                                           double spacing, double pixel_spacings);

}  // namespace drape::meshing
