#include "drape/metrics/camera_error.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "drape/base/error.hpp"

namespace drape::metrics {
namespace {

using Projection = Camera::Projection;

constexpr double deg_per_rad = 180 / std::numbers::pi;

double angle_deg(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond q(rotation);
  return 2 * std::atan2(q.vec().norm(), std::abs(q.w())) * deg_per_rad;
}

double angle_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * deg_per_rad;
}

// The world's axes as seen by a camera in the same place that looks straight at the object.
Eigen::Matrix3d looking_at(const Camera& camera, const Eigen::Vector3d& object_center) {
  const Eigen::Matrix3d rotation = camera.camera_from_world.linear();
  if (camera.projection == Projection::orthographic) return rotation;
  const Eigen::Vector3d ray = camera.camera_from_world * object_center;
  return Eigen::Quaterniond::FromTwoVectors(ray, Eigen::Vector3d::UnitZ()).toRotationMatrix() * rotation;
}

void require_usable(const Camera& camera) {
  if (camera.width <= 0 || camera.height <= 0 || !camera.K.allFinite() || !(focal_px(camera) > 0) ||
      !camera.camera_from_world.matrix().allFinite())
    throw input_error("cannot compare cameras: one of them has no pixels or no focal length");
}

}  // namespace

double focal_px(const Camera& camera) {
  return std::sqrt(std::abs(camera.K.topLeftCorner<2, 2>().determinant()));
}

CameraError camera_error(const Camera& found, const Camera& truth, const Eigen::Vector3d& object_center) {
  require_usable(found);
  require_usable(truth);
  CameraError error;
  error.rotation_deg =
      angle_deg(found.camera_from_world.linear() * truth.camera_from_world.linear().transpose());
  error.rotation_about_ray_deg =
      angle_deg(looking_at(found, object_center) * looking_at(truth, object_center).transpose());
  error.direction_deg = angle_deg(found.towards_camera(object_center), truth.towards_camera(object_center));
  if (found.projection == Projection::perspective && truth.projection == Projection::perspective)
    error.center_distance = (found.center() - truth.center()).norm();
  if (found.projection == truth.projection)
    error.focal_percent = 100 * (focal_px(found.resized(truth.width, truth.height)) / focal_px(truth) - 1);
  return error;
}

}  // namespace drape::metrics
