#include "pose_step.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace drape::texturing {

PoseFrame::PoseFrame(const Camera& camera, const Eigen::Vector3d& middle)
    : camera_(camera), pivot_(camera.camera_from_world * middle), unit_(1) {
  const bool perspective = camera.projection == Camera::Projection::perspective;
  // A quarter of an orthographic picture stands for the distance.
  unit_ = perspective ? std::abs(pivot_.z()) : camera.width / std::abs(camera.K(0, 0)) / 4;
}

Camera PoseFrame::moved(const PoseStep& step) const {
  const double angle = step.head<3>().norm();
  const Eigen::AngleAxisd turn(
      angle, angle > 0 ? Eigen::Vector3d(step.head<3>() / angle) : Eigen::Vector3d(Eigen::Vector3d::UnitZ()));
  Camera moved = camera_;
  moved.K.topLeftCorner<2, 2>() *= std::exp(step[6]);
  moved.camera_from_world = Eigen::Translation3d(pivot_ + unit_ * step.segment<3>(3)) * turn *
                            Eigen::Translation3d(-pivot_) * camera_.camera_from_world;
  return moved;
}

Eigen::Matrix<double, 2, 7> PoseFrame::jacobian(const Eigen::Vector3d& point_in_world) const {
  const Eigen::Vector3d x = camera_.camera_from_world * point_in_world;
  const Eigen::Matrix2d K = camera_.K.topLeftCorner<2, 2>();
  const bool perspective = camera_.projection == Camera::Projection::perspective;
  const Eigen::Vector2d plane = perspective ? Eigen::Vector2d(x.head<2>() / x.z()) : x.head<2>();
  Eigen::Matrix<double, 2, 3> by_point = Eigen::Matrix<double, 2, 3>::Zero();
  by_point.leftCols<2>().setIdentity();
  if (perspective) {
    by_point.col(2) = -plane;
    by_point /= x.z();
  }
  const Eigen::Vector3d arm = x - pivot_;
  Eigen::Matrix3d by_turn;
  by_turn << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
  Eigen::Matrix<double, 2, 7> j;
  j.leftCols<3>() = K * by_point * by_turn;
  j.middleCols<3>(3) = unit_ * K * by_point;
  j.col(6) = K * plane;
  return j;
}

PoseMatrix prior_on_steps() {
  constexpr double turn = 0.03;   // radians
  constexpr double shift = 0.03;  // of the distance
  constexpr double zoom = 0.02;   // of the focal length
  PoseMatrix prior = PoseMatrix::Zero();
  prior.diagonal() << PoseStep::Constant(1 / (turn * turn));
  prior.diagonal().segment<3>(3).setConstant(1 / (shift * shift));
  prior(6, 6) = 1 / (zoom * zoom);
  return prior;
}

}  // namespace drape::texturing
