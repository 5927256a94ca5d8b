// Where a scanner saw a point.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>

#include "drape/geometry/range_scan.hpp"

namespace drape::registration {

struct Sighting {
  Eigen::Vector2d place;  // in the image plane
  double depth;           // along the ray
};

/// The image plane of a view: across the rays of a parallel one, in units of length; on the octahedral map of
/// directions (Cigolle et al. 2014) round an origin, which covers all of them without a pole, in about
/// radians.
class ViewProjection {
 public:
  /// The view must be known. Rays along `axis` from an origin fall on the middle of the map; those away from
  /// it on its corners.
  explicit ViewProjection(const ScanView& view, const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ());

  /// Nothing for the origin itself.
  [[nodiscard]] std::optional<Sighting> of(const Eigen::Vector3d& point) const {
    if (view_.kind == ScanView::Kind::direction) {
      const Eigen::Vector3d seen = axes_ * point;
      return Sighting{seen.head<2>(), seen.z()};
    }
    const Eigen::Vector3d ray = axes_ * (point - view_.vector);
    const double range = ray.norm();
    if (!(range > 0)) return std::nullopt;
    const Eigen::Vector3d d = ray / ray.cwiseAbs().sum();
    Eigen::Vector2d place = d.head<2>();
    if (d.z() < 0)
      place = Eigen::Vector2d((1 - std::abs(d.y())) * (d.x() < 0 ? -1 : 1),
                              (1 - std::abs(d.x())) * (d.y() < 0 ? -1 : 1));
    return Sighting{place, range};
  }

 private:
  ScanView view_;
  Eigen::Matrix3d axes_;
};

}  // namespace drape::registration
