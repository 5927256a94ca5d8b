// Where a scanner looked, whether anything came back or not.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "drape/geometry/range_scan.hpp"

namespace drape::registration {

/// The rectangle of rays that a scan's grid covers, as an affine map from the image plane to rows and columns
/// (parallel rays, or a pinhole round the mean ray). Unknown without a grid or a view, in scenes, and where
/// the grid is of another kind, as that of a scanner which turns about itself.
class FieldOfView {
 public:
  explicit FieldOfView(const RangeScan& scan);

  [[nodiscard]] bool known() const { return known_; }
  /// Whether a ray of the scanner passed `point`, some cells inside the border; false where it is not known.
  [[nodiscard]] bool contains(const Eigen::Vector3d& point) const;

 private:
  [[nodiscard]] std::optional<Eigen::Vector3d> place_of(const Eigen::Vector3d& point) const;

  ScanView view_;
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();                                 // rays along the last
  Eigen::Matrix<double, 2, 3> cell_from_place_ = Eigen::Matrix<double, 2, 3>::Zero();  // of (x, y, 1)
  Eigen::Array2d size_ = Eigen::Array2d::Zero();
  bool known_ = false;
};

}  // namespace drape::registration
