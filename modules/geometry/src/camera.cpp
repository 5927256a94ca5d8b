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

}  // namespace drape
