// The coordinates that the exhaustive search works in, and the camera that they amount to.
#pragma once

#include <Eigen/Core>

#include "drape/geometry/camera.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::alignment {

/// Rotation by angles in degrees about the camera's axes: first pitch (about x), then yaw (y), then roll (z).
struct EulerAngles {
  double pitch_deg = 0;
  double yaw_deg = 0;
  double roll_deg = 0;

  [[nodiscard]] Eigen::Matrix3d matrix() const;
};

/// Where the model is: point_in_camera = diag(sx, sy, 1) * R * point_in_canonical + (tx, ty, depth). Scale
/// after rotation, and no scale along the optical axis (thesis 4.2.2). A scale of 1 at the canonical depth
/// shows the model's cube -1..1 as large as the longer side of the image.
struct ModelPose {
  EulerAngles angles;
  Eigen::Vector2d translation = Eigen::Vector2d::Zero();
  Eigen::Vector2d scale = Eigen::Vector2d::Ones();
  double depth = 1;
  double fov_deg = 45;  // horizontal; of no meaning for an orthographic camera
};

/// Model and image in -1..1 (thesis 4.2): the model by its middle and its longest side, the image by its
/// middle and its longer side.
class CanonicalFrame {
 public:
  /// Error{input} for a mesh without extent.
  CanonicalFrame(const TriangleMesh& mesh, Camera::Projection projection, int photo_width, int photo_height);

  /// The pose in which the canonical cube fills the image. With a wide field of view the model would reach
  /// behind the camera there: it is then kept further away.
  [[nodiscard]] ModelPose start(double fov_deg) const;

  /// About the same view with the scale, as far as it is the same in x and y, put into the depth:
  /// "translating along the z-axis produces the same effect as scaling" (thesis 4.2.1), except that the
  /// model's own depth shrinks with it, so that the perspective becomes that of the field of view.
  /// Orthographic: as it is.
  [[nodiscard]] ModelPose scaled_by_distance(const ModelPose& pose) const;

  /// The same view as a pinhole with two focal lengths (or an orthographic camera with two scales) at the
  /// photo's size: the x and y scales, which come after the rotation, belong to the image as much as to the
  /// model.
  [[nodiscard]] Camera camera(const ModelPose& pose) const;

  /// A shift in pixels of the photo as a translation of the pose.
  [[nodiscard]] Eigen::Vector2d translation_of(const Eigen::Vector2d& shift_px, const ModelPose& pose) const {
    return shift_px / px_per_unit(pose);
  }
  /// The point of the plane at the pose's depth that is seen at a pixel of the photo.
  [[nodiscard]] Eigen::Vector2d place_at_depth(const Eigen::Vector2d& pixel, const ModelPose& pose) const {
    return (pixel - principal_point_) / px_per_unit(pose);
  }

 private:
  [[nodiscard]] double focal_px(const ModelPose& pose) const;
  [[nodiscard]] double px_per_unit(const ModelPose& pose) const;  // at the pose's depth

  Camera::Projection projection_;
  int width_;
  int height_;
  Eigen::Vector2d principal_point_;
  Eigen::Vector3d model_center_;
  double units_per_canonical_ = 1;  // of the mesh
  double radius_ = 1;               // of the model about its centre, canonical
};

}  // namespace drape::alignment
