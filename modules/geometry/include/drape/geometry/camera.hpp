// Pinhole and orthographic cameras, with OpenCV's axes: x right, y down, z forward.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "drape/geometry/rigid3.hpp"

namespace drape {

/// An image of width x height pixels; pixel centres at +0.5, origin at the top left corner.
///
/// Perspective: pixel = (K x_camera) / z. Orthographic: pixel = K (x, y, 1), so that K's diagonal holds
/// pixels per metre and z is dropped. K may have two different focal lengths, and shear; its last row is 0
/// 0 1.
struct Camera {
  enum class Projection { perspective, orthographic };

  Projection projection = Projection::perspective;
  int width = 0;
  int height = 0;
  Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
  Rigid3 camera_from_world = Rigid3::Identity();

  /// Pixel position (x, y) and depth along the optical axis. A perspective camera does not see points with
  /// depth <= 0; their pixel is meaningless.
  struct Projected {
    Eigen::Vector2d pixel;
    double depth;
  };
  [[nodiscard]] Projected project(const Eigen::Vector3d& point_in_world) const;

  /// pixel ~ P * (X, 1), the 3x4 projection matrix; of an orthographic camera the last row is 0 0 0 1.
  [[nodiscard]] Eigen::Matrix<double, 3, 4> P() const;

  /// The point at `depth` (along the optical axis) that projects to `pixel`.
  [[nodiscard]] Eigen::Vector3d unproject(const Eigen::Vector2d& pixel, double depth) const;

  /// Optical centre in the world; of an orthographic camera the camera frame's origin, which only its axis
  /// matters of.
  [[nodiscard]] Eigen::Vector3d center() const { return camera_from_world.inverse().translation(); }

  /// Unit vector from the point towards the camera.
  [[nodiscard]] Eigen::Vector3d towards_camera(const Eigen::Vector3d& point_in_world) const;

  /// The same view at another image size; the two axes may scale differently.
  [[nodiscard]] Camera resized(int new_width, int new_height) const;
};

/// A camera at `eye` that looks at `target`; `up` is what points upwards in the image (not parallel to the
/// view). Square pixels, principal point in the middle, horizontal field of view in degrees.
[[nodiscard]] Camera look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target,
                             const Eigen::Vector3d& up, int width, int height, double horizontal_fov_deg);

/// The camera of a projection matrix, whatever its scale and sign: its left half is K times a rotation (an
/// upper triangular matrix with a positive diagonal times an orthogonal one; Hartley and Zisserman 2004,
/// 6.2.4). A last row of 0 0 0 w is an orthographic camera. Nothing for a matrix that is no camera's.
[[nodiscard]] std::optional<Camera> camera_from_matrix(const Eigen::Matrix<double, 3, 4>& P, int width,
                                                       int height);

}  // namespace drape
