#include "outline_pose.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace drape::alignment {
namespace {

constexpr double most_perspective = 0.85;
// A pinhole needs a distance: this many radii is beyond what any outline could tell from infinity.
constexpr double least_perspective = 1e-4;

}  // namespace

PoseVector place_derivative(const OutlinePose& pose, const Eigen::Vector3d& turned,
                            const Eigen::Vector2d& direction) {
  const double w = 1 / (1 + pose.perspective * turned.z());
  const Eigen::Vector2d x = (pose.scale * turned.head<2>() + pose.shift) * w;
  const double along = direction.dot(x);
  // d place / d turned; a rotation vector r moves `turned` by cross(r, turned).
  const Eigen::Vector3d gradient(direction.x() * pose.scale * w, direction.y() * pose.scale * w,
                                 -along * pose.perspective * w);
  PoseVector d;
  d.head<3>() = turned.cross(gradient);
  d[3] = direction.dot(turned.head<2>()) * w;
  d.segment<2>(4) = direction * w;
  d[6] = -along * turned.z() * w;
  d.tail<2>() = direction;
  return d;
}

OutlinePose moved(const OutlinePose& pose, const PoseVector& step) {
  OutlinePose result = pose;
  const double angle = step.head<3>().norm();
  if (angle > 0)
    result.rotation = Eigen::AngleAxisd(angle, step.head<3>() / angle).toRotationMatrix() * pose.rotation;
  result.scale = std::max(pose.scale + step[3], 0.2 * pose.scale);
  result.shift += step.segment<2>(4);
  result.perspective = std::clamp(pose.perspective + step[6], 0.0, most_perspective);
  result.principal += step.tail<2>();
  return result;
}

double angle_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::AngleAxisd(a * b.transpose()).angle();
}

Camera camera_of(const OutlinePose& pose, const UnitSphere& sphere, Camera::Projection projection,
                 const Eigen::Vector2d& principal_px, int width, int height) {
  Camera camera;
  camera.projection = projection;
  camera.width = width;
  camera.height = height;
  const bool perspective = projection == Camera::Projection::perspective;
  const double p = std::max(pose.perspective, least_perspective);
  const double focal = perspective ? pose.scale / p : pose.scale / sphere.radius;
  const Eigen::Vector2d principal = principal_px + pose.principal;
  camera.K << focal, 0, principal.x(), 0, focal, principal.y(), 0, 0, 1;
  // Re-made orthogonal: many small steps leave rounding behind.
  camera.camera_from_world.linear() = Eigen::Quaterniond(pose.rotation).normalized().toRotationMatrix();
  const Eigen::Vector3d middle(pose.shift.x() / pose.scale, pose.shift.y() / pose.scale,
                               perspective ? 1 / p : 2.0);
  camera.camera_from_world.translation() =
      sphere.radius * middle - camera.camera_from_world.linear() * sphere.center;
  return camera;
}

std::optional<OutlinePose> pose_of(const Camera& camera, const UnitSphere& sphere,
                                   const Eigen::Vector2d& principal_px) {
  const Eigen::Vector3d middle = camera.camera_from_world * sphere.center / sphere.radius;
  const double focal = std::sqrt(camera.K(0, 0) * camera.K(1, 1));
  OutlinePose pose;
  pose.rotation = camera.camera_from_world.linear();
  pose.principal = camera.K.block<2, 1>(0, 2) - principal_px;
  if (camera.projection == Camera::Projection::perspective) {
    if (!(middle.z() > 1 / most_perspective)) return std::nullopt;
    pose.perspective = 1 / middle.z();
    pose.scale = focal / middle.z();
  } else {
    pose.scale = focal * sphere.radius;
  }
  pose.shift = pose.scale * middle.head<2>();
  if (!(pose.scale > 0) || !pose.shift.allFinite() || !pose.principal.allFinite()) return std::nullopt;
  return pose;
}

}  // namespace drape::alignment
