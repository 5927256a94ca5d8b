// What one photo sees of a surface.
#pragma once

#include <Eigen/Core>
#include <array>

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

  /// Gives the depth picture's memory back: sees() and blocked() must not be asked any more.
  void forget_depth() { depth_ = {}; }

  /// Where in the photo a point in front of the camera is looked up: its projection, warped.
  [[nodiscard]] Eigen::Vector2d pixel_of(const Eigen::Vector3d& point) const {
    return lookup_of(camera_.project(point).pixel);
  }
  /// The same of a projection.
  [[nodiscard]] Eigen::Vector2d lookup_of(const Eigen::Vector2d& projected) const { return warp_(projected); }
  /// How far the pixel at a position in the photo is trusted.
  [[nodiscard]] std::uint8_t trust_at(const Eigen::Vector2d& pixel) const;

  /// trust::none if the photo does not see the point, sees it too obliquely, or may not use what is there;
  /// else how far the pixel it falls on is trusted. `normal`: the
  /// surface's, smoothed; `face_normal`: of the face the point lies on; unit length, outwards. A point is
  /// hidden if any of the sixteen pixels round it shows something in front of it: bilinear filtering blends
  /// four of them, and with the others points up to a pixel away are safe as well.
  [[nodiscard]] std::uint8_t sees(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                                  const Eigen::Vector3d& face_normal) const;

  /// Whether an exact ray from the point meets something on its way to the camera; near itself the surface
  /// does not count. `cosine`: of the incidence, for what counts as near.
  [[nodiscard]] bool blocked(const Eigen::Vector3d& point, double cosine) const;

  /// Whether every point of a small triangle is seen on fully trusted pixels, beyond doubt: nothing lies in
  /// front of its plane anywhere near it. Where it is false, sees() tells. `projected`: the corners as the
  /// camera projects them; `normals`: the surface's there, unit length.
  [[nodiscard]] bool sees_plainly(const std::array<Eigen::Vector3d, 3>& corners,
                                  const std::array<Camera::Projected, 3>& projected,
                                  const std::array<Eigen::Vector3d, 3>& normals,
                                  const Eigen::Vector3d& face_normal) const;

  /// Whether the pixel lies in the photo, give or take `margin_px`.
  [[nodiscard]] bool holds(const Eigen::Vector2d& pixel, double margin_px = 0) const;

 private:
  enum class InFront { nothing, perhaps, something };
  // A plane, as far as the depth picture's pixels tell what is in front of it: both sides of
  // (depth + tolerance) lean < offset are linear in the pixel.
  struct Plane {
    Eigen::Vector3d lean;  // by the pixel
    double offset;
    double slope;  // depth counts so much, if orthographic
  };
  // Pixels of the depth picture: columns left <= x < right.
  struct DepthPixels {
    int left;
    int top;
    int right;
    int bottom;
  };
  [[nodiscard]] Plane plane_of(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const;
  [[nodiscard]] bool is_before(const Plane& plane, int x, int y, double depth) const;
  [[nodiscard]] bool is_on(const Plane& plane, int x, int y, double depth, double tolerance) const;
  [[nodiscard]] DepthPixels pixels_round(const Eigen::Vector2d& least, const Eigen::Vector2d& most) const;
  [[nodiscard]] double pixel_size_at(double depth) const;
  [[nodiscard]] double least_tolerance_at(double pixel_size, double cosine) const;
  [[nodiscard]] InFront in_front(const Camera::Projected& seen, const Eigen::Vector3d& point,
                                 const Eigen::Vector3d& normal, const Eigen::Vector3d& face_normal,
                                 double least_tolerance, double tolerance, bool oblique) const;

  Camera camera_;
  OutlineWarp warp_;
  ImageF depth_;                        // perhaps smaller than the photo
  Eigen::Matrix3d ray_of_depth_pixel_;  // of unit depth, from (x, y, 1)
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
