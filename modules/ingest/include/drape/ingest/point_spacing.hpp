// How far apart the samples of a scan lie: the unit of most of drape's options.
#pragma once

#include <Eigen/Core>

#include "drape/geometry/range_scan.hpp"

namespace drape::ingest {

/// Median distance of neighbouring samples, in the scan's unit; 0 for fewer than 2 distinct points. With a
/// grid it is that of lattice neighbours across the viewing rays (the geometric mean of the medians along
/// rows and along columns), because range noise inflates distances in space; without one, the median over
/// the points of the mean distance to the 4 nearest others, which on a square lattice is the same. The
/// points must be finite and distinct.
[[nodiscard]] double point_spacing(const RangeScan& scan);

/// The spacing at each place of a scan: rays that diverge from an origin lie further apart on far surfaces.
class LocalSpacing {
 public:
  /// `spacing` is the scan's median spacing, which holds at the median distance from the scanner.
  LocalSpacing(const RangeScan& scan, double spacing);
  [[nodiscard]] double at(const Eigen::Vector3d& point) const { return spacing_ * ratio(point); }
  /// Local over median spacing.
  [[nodiscard]] double ratio(const Eigen::Vector3d& point) const {
    return median_range_ > 0 ? (point - origin_).norm() / median_range_ : 1.0;
  }

 private:
  double spacing_;
  double median_range_ = 0;  // 0: the rays do not diverge
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
};

}  // namespace drape::ingest
