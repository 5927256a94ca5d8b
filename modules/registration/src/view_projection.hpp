// Where a scanner saw a point.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
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
  /// The view must be known.
  explicit ViewProjection(const ScanView& view) : view_(view) {
    if (view.kind != ScanView::Kind::direction) return;
    right_ = view.vector.unitOrthogonal();
    down_ = view.vector.cross(right_);
  }

  /// Nothing for the origin itself.
  [[nodiscard]] std::optional<Sighting> of(const Eigen::Vector3d& point) const {
    if (view_.kind == ScanView::Kind::direction)
      return Sighting{Eigen::Vector2d(right_.dot(point), down_.dot(point)), view_.vector.dot(point)};
    const Eigen::Vector3d ray = point - view_.vector;
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
  Eigen::Vector3d right_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d down_ = Eigen::Vector3d::Zero();
};

}  // namespace drape::registration
