// One Gauss-Newton step of a rigid motion.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "drape/geometry/rigid3.hpp"

namespace drape::registration {

/// Sums over weighted distances d of points p to planes with normal n, for the small motion (rotation about
/// `center`, translation) that makes the sum of their squares least: d changes by [(p - center) x n, n] * x.
class MotionStep {
 public:
  explicit MotionStep(const Eigen::Vector3d& center) : center_(center) {}

  void add(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, double distance, double weight) {
    Vector6 row;
    row << (point - center_).cross(normal), normal;
    H_.noalias() += weight * row * row.transpose();
    g_ += weight * distance * row;
  }

  struct Moved {
    Rigid3 motion;
    double size;  // about the largest shift of a point within the radius
  };
  /// The motion after the step; `radius` is about how far the points lie from the center, so that angles and
  /// lengths compare. A little damping (relative to the mean of what the directions of motion are held with)
  /// leaves at rest what nothing determines.
  [[nodiscard]] Moved applied_to(const Rigid3& motion, double radius, double damping) const;

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  Eigen::Vector3d center_;
  Matrix6 H_ = Matrix6::Zero();
  Vector6 g_ = Vector6::Zero();
};

}  // namespace drape::registration
