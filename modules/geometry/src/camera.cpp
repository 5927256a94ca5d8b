#include "drape/geometry/camera.hpp"

#include <cmath>
#include <numbers>

namespace drape {

Camera::Projected Camera::project(const Eigen::Vector3d& point_in_world) const {
  const Eigen::Vector3d x = camera_from_world * point_in_world;
  const Eigen::Vector3d image =
      K * (projection == Projection::perspective ? x : Eigen::Vector3d(x.x(), x.y(), 1.0));
  return {image.head<2>() / image.z(), x.z()};
}

Eigen::Matrix<double, 3, 4> Camera::P() const {
  Eigen::Matrix<double, 3, 4> extrinsic = camera_from_world.matrix().topRows<3>();
  if (projection == Projection::orthographic) extrinsic.row(2) << 0, 0, 0, 1;
  return K * extrinsic;
}

Eigen::Vector3d Camera::unproject(const Eigen::Vector2d& pixel, double depth) const {
  Eigen::Vector3d x = K.inverse() * Eigen::Vector3d(pixel.x(), pixel.y(), 1.0);
  if (projection == Projection::perspective)
    x *= depth;
  else
    x.z() = depth;
  return camera_from_world.inverse() * x;
}

Eigen::Vector3d Camera::towards_camera(const Eigen::Vector3d& point_in_world) const {
  if (projection == Projection::perspective) return (center() - point_in_world).normalized();
  return -(camera_from_world.linear().transpose() * Eigen::Vector3d::UnitZ());
}

Camera Camera::resized(int new_width, int new_height) const {
  Camera scaled = *this;
  scaled.width = new_width;
  scaled.height = new_height;
  const Eigen::Vector3d factors(static_cast<double>(new_width) / width,
                                static_cast<double>(new_height) / height, 1.0);
  scaled.K = factors.asDiagonal() * K;
  return scaled;
}

Camera look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, const Eigen::Vector3d& up,
               int width, int height, double horizontal_fov_deg) {
  const Eigen::Vector3d forward = (target - eye).normalized();
  const Eigen::Vector3d right = forward.cross(up).normalized();
  const Eigen::Vector3d down = forward.cross(right);
  Camera camera;
  camera.width = width;
  camera.height = height;
  const double focal_px = width / 2.0 / std::tan(horizontal_fov_deg * std::numbers::pi / 360.0);
  camera.K << focal_px, 0, width / 2.0, 0, focal_px, height / 2.0, 0, 0, 1;
  camera.camera_from_world.linear().row(0) = right;
  camera.camera_from_world.linear().row(1) = down;
  camera.camera_from_world.linear().row(2) = forward;
  camera.camera_from_world.translation() = -(camera.camera_from_world.linear() * eye);
  return camera;
}

namespace {

// M = K R with K upper triangular and a positive diagonal: Gram and Schmidt on the rows, from the last one
// up.
struct UpperTimesRotation {
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d R;
};
UpperTimesRotation upper_times_rotation(const Eigen::Matrix3d& M) {
  UpperTimesRotation result;
  for (int i = 2; i >= 0; --i) {
    Eigen::RowVector3d rest = M.row(i);
    for (int j = 2; j > i; --j) {
      result.K(i, j) = M.row(i).dot(result.R.row(j));
      rest -= result.K(i, j) * result.R.row(j);
    }
    result.K(i, i) = rest.norm();
    result.R.row(i) = rest / result.K(i, i);
  }
  return result;
}

}  // namespace

std::optional<Camera> camera_from_matrix(const Eigen::Matrix<double, 3, 4>& P, int width, int height) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  if (!P.allFinite()) return std::nullopt;
  if (P.row(2).head<3>().isZero(0)) {
    if (P(2, 3) == 0) return std::nullopt;
    camera.projection = Camera::Projection::orthographic;
    const Eigen::Matrix<double, 2, 4> top = P.topRows<2>() / P(2, 3);
    Eigen::Matrix3d M;
    M << top.leftCols<3>(), top.row(0).head<3>().cross(top.row(1).head<3>()).normalized();
    const UpperTimesRotation parts = upper_times_rotation(M);
    camera.K = parts.K;
    camera.K.col(2) << width / 2.0, height / 2.0, 1;
    camera.camera_from_world.linear() = parts.R;
    const Eigen::Vector2d shift = top.col(3) - camera.K.block<2, 1>(0, 2);
    camera.camera_from_world.translation() << camera.K.topLeftCorner<2, 2>().inverse() * shift, 0;
  } else {
    const double sign = P.leftCols<3>().determinant() < 0 ? -1 : 1;
    const UpperTimesRotation parts = upper_times_rotation(sign * P.leftCols<3>());
    camera.K = parts.K / parts.K(2, 2);
    camera.camera_from_world.linear() = parts.R;
    camera.camera_from_world.translation() = parts.K.inverse() * (sign * P.col(3));
  }
  const bool sound = camera.K.allFinite() && camera.camera_from_world.matrix().allFinite() &&
                     camera.K(0, 0) > 0 && camera.K(1, 1) > 0;
  return sound ? std::optional<Camera>(camera) : std::nullopt;
}

}  // namespace drape
