// The seven (nine) numbers that an outline depends on.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "drape/geometry/camera.hpp"
#include "outline_mesh.hpp"

namespace drape::alignment {

/// Where a mesh in its unit sphere is, in the axes of the camera (x right, y down, z forward). With (a, b, c)
/// = rotation * x_unit, seen at pixels about the principal point
///
///   x = (scale * a + shift.x) / (1 + perspective * c),   y likewise,
///
/// which is a pinhole of focal length scale / perspective at the distance 1 / perspective, in radii. It is
/// smooth down to perspective = 0, an orthographic camera, where focal length and distance are not.
struct OutlinePose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  double scale = 1;
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  double perspective = 0;                               // 0 to below 1
  Eigen::Vector2d principal = Eigen::Vector2d::Zero();  // of the principal point, against the assumed one

  /// The pixel, about the assumed principal point, of `turned` = rotation * x_unit.
  [[nodiscard]] Eigen::Vector2d place(const Eigen::Vector3d& turned) const {
    return (scale * turned.head<2>() + shift) / (1 + perspective * turned.z()) + principal;
  }
};

/// Order of the parameters: rotation vector (in camera axes, from the left), scale, shift, perspective,
/// principal point.
inline constexpr int pose_parameters = 9;
using PoseVector = Eigen::Matrix<double, pose_parameters, 1>;
using PoseMatrix = Eigen::Matrix<double, pose_parameters, pose_parameters>;

/// Change of dot(direction, place(turned)) with each parameter. A point of the rim moves with the pose as if
/// it were fixed to the body: how it slides over the surface is along the outline.
[[nodiscard]] PoseVector place_derivative(const OutlinePose& pose, const Eigen::Vector3d& turned,
                                          const Eigen::Vector2d& direction);

/// The pose after a small step; perspective stays within what keeps the body before the camera.
[[nodiscard]] OutlinePose moved(const OutlinePose& pose, const PoseVector& step);

/// Angle between two rotations.
[[nodiscard]] double angle_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b);

/// The pinhole (or orthographic camera) of this pose, for square pixels and the assumed principal point.
[[nodiscard]] Camera camera_of(const OutlinePose& pose, const UnitSphere& sphere,
                               Camera::Projection projection, const Eigen::Vector2d& principal_px, int width,
                               int height);

/// The pose of a camera, whose two focal lengths are taken as one. Nothing where the sphere's middle is not
/// before it.
[[nodiscard]] std::optional<OutlinePose> pose_of(const Camera& camera, const UnitSphere& sphere,
                                                 const Eigen::Vector2d& principal_px);

}  // namespace drape::alignment
