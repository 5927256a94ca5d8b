#include "motion_step.hpp"

#include <Eigen/Cholesky>

namespace drape::registration {

MotionStep::Moved MotionStep::applied_to(const Rigid3& motion, double radius, double damping) const {
  Vector6 units;
  units << Eigen::Vector3d::Constant(1 / radius), Eigen::Vector3d::Ones();
  const Matrix6 scaled = units.asDiagonal() * H_ * units.asDiagonal();
  const Matrix6 damped = scaled + damping * scaled.trace() / 6 * Matrix6::Identity();
  const Vector6 step = units.asDiagonal() * damped.ldlt().solve(units.asDiagonal() * -g_);
  if (!step.allFinite()) return {motion, 0};
  const Eigen::Vector3d rotation = step.head<3>();
  const double angle = rotation.norm();
  Rigid3 change = Rigid3::Identity();
  if (angle > 0) change.linear() = Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
  change.translation() = center_ + step.tail<3>() - change.linear() * center_;
  Rigid3 result = change * motion;
  result.linear() = Eigen::Quaterniond(result.linear()).normalized().toRotationMatrix();
  return {result, angle * radius + step.tail<3>().norm()};
}

}  // namespace drape::registration
