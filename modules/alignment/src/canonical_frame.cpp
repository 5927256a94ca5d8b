#include "canonical_frame.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "drape/base/error.hpp"
#include "drape/geometry/bounding_box.hpp"

namespace drape::alignment {
namespace {

constexpr double radians = std::numbers::pi / 180;
constexpr double least_depth_radii = 1.25;  // of the model's radius: no part of it comes near the camera

}  // namespace

Eigen::Matrix3d EulerAngles::matrix() const {
  return (Eigen::AngleAxisd(roll_deg * radians, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(yaw_deg * radians, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(pitch_deg * radians, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

CanonicalFrame::CanonicalFrame(const TriangleMesh& mesh, Camera::Projection projection, int photo_width,
                               int photo_height)
    : projection_(projection),
      width_(photo_width),
      height_(photo_height),
      principal_point_(photo_width / 2.0, photo_height / 2.0) {
  BoundingBox box;
  for (const Face& face : mesh.faces)
    for (const std::uint32_t v : face) box.extend(mesh.vertices[v]);
  if (box.isEmpty()) throw input_error("the mesh has no faces: there is nothing to align");
  if (!(box.diagonal().maxCoeff() > 0)) throw input_error("all faces of the mesh lie in one point");
  model_center_ = box.center();
  units_per_canonical_ = box.diagonal().maxCoeff() / 2;
  double squared = 0;
  for (const Face& face : mesh.faces)
    for (const std::uint32_t v : face)
      squared = std::max(squared, (mesh.vertices[v] - model_center_).squaredNorm());
  radius_ = std::sqrt(squared) / units_per_canonical_;
}

double CanonicalFrame::focal_px(const ModelPose& pose) const {
  return width_ / 2.0 / std::tan(pose.fov_deg * radians / 2);
}

double CanonicalFrame::px_per_unit(const ModelPose& pose) const {
  if (projection_ == Camera::Projection::orthographic) return std::max(width_, height_) / 2.0;
  return focal_px(pose) / pose.depth;
}

ModelPose CanonicalFrame::start(double fov_deg) const {
  ModelPose pose;
  pose.fov_deg = fov_deg;
  pose.depth = least_depth_radii * radius_;
  if (projection_ == Camera::Projection::perspective)
    pose.depth = std::max(pose.depth, focal_px(pose) / (std::max(width_, height_) / 2.0));
  return pose;
}

ModelPose CanonicalFrame::scaled_by_distance(const ModelPose& pose) const {
  if (projection_ == Camera::Projection::orthographic) return pose;
  ModelPose moved = pose;
  moved.depth = std::max(pose.depth / std::sqrt(pose.scale.prod()), least_depth_radii * radius_);
  // What is seen at a pixel lies further out at a larger depth.
  moved.translation *= moved.depth / pose.depth;
  moved.scale.setConstant(std::sqrt(pose.scale.prod()) * moved.depth / pose.depth);
  return moved;
}

Camera CanonicalFrame::camera(const ModelPose& pose) const {
  // Perspective: u - cx = f (sx X + tx) / (Z + depth) = (f sx) (X + tx / sx) / (Z + depth).
  // Orthographic: u - cx = c (sx X + tx) = (c sx) (X + tx / sx), and X is in canonical units.
  Camera camera;
  camera.projection = projection_;
  camera.width = width_;
  camera.height = height_;
  const double per_unit = projection_ == Camera::Projection::perspective
                              ? focal_px(pose)
                              : px_per_unit(pose) / units_per_canonical_;
  camera.K << per_unit * pose.scale.x(), 0, principal_point_.x(), 0, per_unit * pose.scale.y(),
      principal_point_.y(), 0, 0, 1;
  const Eigen::Matrix3d rotation = pose.angles.matrix();
  const Eigen::Vector2d shift = pose.translation.cwiseQuotient(pose.scale);
  camera.camera_from_world.linear() = rotation;
  camera.camera_from_world.translation() =
      units_per_canonical_ * Eigen::Vector3d(shift.x(), shift.y(), pose.depth) - rotation * model_center_;
  return camera;
}

}  // namespace drape::alignment
