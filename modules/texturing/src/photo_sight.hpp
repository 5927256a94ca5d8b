// What one photo sees of a surface.
#pragma once

#include <Eigen/Core>

#include "drape/geometry/camera.hpp"
#include "drape/geometry/ray_caster.hpp"
#include "drape/geometry/triangle_mesh.hpp"
#include "drape/rendering/renderer.hpp"
#include "outline_warp.hpp"
#include "usable_pixels.hpp"

namespace drape::texturing {

/// Answers for one photo and points of a surface close to the mesh that hides things from it.
class PhotoSight {
 public:
  /// `depth`: what the centre of each pixel sees (front or back), along the optical axis; as large as the
  /// photo or smaller. A point counts as hidden where it lies more than `tolerance` behind (in the unit of
  /// the mesh). `full`: what may be in front, for where the depth picture is too coarse to tell; it is
  /// referred to.
  PhotoSight(const Camera& camera, OutlineWarp warp, ImageF depth, Image8 trusted, double tolerance,
             double max_incidence_deg, const RayCaster& full);

  [[nodiscard]] const Camera& camera() const { return camera_; }
  [[nodiscard]] const Image8& trusted() const { return trusted_; }

  /// Gives the depth picture's memory back: sees() must not be asked any more.
  void forget_depth() { depth_ = {}; }

  /// Where in the photo a point in front of the camera is looked up: its projection, warped.
  [[nodiscard]] Eigen::Vector2d pixel_of(const Eigen::Vector3d& point) const {
    return warp_(camera_.project(point).pixel);
  }
  /// How far the pixel at a position in the photo is trusted.
  [[nodiscard]] std::uint8_t trust_at(const Eigen::Vector2d& pixel) const;

  /// trust::none if the photo does not see the point, sees it too obliquely, or may not use what is there;
  /// else how far the pixel it falls on is trusted. `normal`: the
  /// surface's, smoothed; `face_normal`: of the face the point lies on; unit length, outwards. A point is
  /// hidden if any of the sixteen pixels round it shows something in front of it: bilinear filtering blends
  /// four of them, and with the others points up to a pixel away are safe as well.
  [[nodiscard]] std::uint8_t sees(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                                  const Eigen::Vector3d& face_normal) const;

  /// Whether the pixel lies in the photo, give or take `margin_px`.
  [[nodiscard]] bool holds(const Eigen::Vector2d& pixel, double margin_px = 0) const;

 private:
  enum class InFront { nothing, perhaps, something };
  [[nodiscard]] InFront in_front(const Camera::Projected& seen, const Eigen::Vector3d& point,
                                 const Eigen::Vector3d& normal, const Eigen::Vector3d& face_normal,
                                 double least_tolerance, double tolerance) const;
  [[nodiscard]] bool ray_blocked(const Eigen::Vector3d& point, double tolerance) const;

  Camera camera_;
  OutlineWarp warp_;
  Eigen::Matrix3d camera_from_pixel_;  // K^-1
  ImageF depth_;                       // perhaps smaller than the photo
  Image8 trusted_;
  double tolerance_;
  double least_cosine_;
  const RayCaster* full_;
};

/// The photo's camera, reduced if the photo is larger than a depth map can be.
[[nodiscard]] Camera depth_camera(const Camera& camera);

/// How far one surface lies from the other where a camera sees both: three times the 95th percentile of the
/// distance along the normal. 0 where they are the same; never more than 2 % of the extent.
[[nodiscard]] double surface_deviation(const rendering::DepthMap& of_simplified,
                                       const TriangleMesh& simplified, const rendering::DepthMap& of_full,
                                       const Camera& camera);

}  // namespace drape::texturing
