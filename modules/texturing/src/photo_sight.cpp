#include "photo_sight.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "drape/geometry/bounding_box.hpp"

namespace drape::texturing {
namespace {

constexpr int largest_depth_map_px = 8192;
constexpr double steepest_slope = 10;  // tangent of the incidence up to which the tolerance grows
constexpr double clear_slope = 1;      // beyond the tolerance of this one a ray decides

}  // namespace

PhotoSight::PhotoSight(const Camera& camera, OutlineWarp warp, ImageF depth, Image8 trusted, double tolerance,
                       double max_incidence_deg, const RayCaster& full)
    : camera_(camera),
      warp_(std::move(warp)),
      camera_from_pixel_(camera.K.inverse()),
      depth_(std::move(depth)),
      trusted_(std::move(trusted)),
      tolerance_(tolerance),
      least_cosine_(std::cos(max_incidence_deg * std::numbers::pi / 180)),
      full_(&full) {}

bool PhotoSight::holds(const Eigen::Vector2d& pixel, double margin_px) const {
  return pixel.x() >= -margin_px && pixel.y() >= -margin_px && pixel.x() <= camera_.width + margin_px &&
         pixel.y() <= camera_.height + margin_px;
}

std::uint8_t PhotoSight::trust_at(const Eigen::Vector2d& pixel) const {
  if (!holds(pixel)) return trust::none;
  return trusted_.at(std::min(static_cast<int>(pixel.x()), camera_.width - 1),
                     std::min(static_cast<int>(pixel.y()), camera_.height - 1));
}

std::uint8_t PhotoSight::sees(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                              const Eigen::Vector3d& face_normal) const {
  const Camera::Projected seen = camera_.project(point);
  const bool perspective = camera_.projection == Camera::Projection::perspective;
  if (perspective && !(seen.depth > 0)) return trust::none;
  if (!holds(seen.pixel)) return trust::none;
  const double cosine = normal.dot(camera_.towards_camera(point));
  if (!(cosine >= least_cosine_)) return trust::none;
  const std::uint8_t level = trust_at(warp_(seen.pixel));
  if (level == trust::none) return trust::none;
  // A pixel of the depth map tells the depth within its own width only: the steeper the surface, the less
  // exactly.
  const double pixels_per_unit = std::sqrt(std::abs(camera_.K(0, 0) * camera_.K(1, 1)));
  const double pixel_size =
      (perspective ? seen.depth : 1.0) / pixels_per_unit * camera_.width / depth_.width();
  const double slope = std::min(steepest_slope, std::sqrt(std::max(0.0, 1 - cosine * cosine)) / cosine);
  const InFront front = in_front(seen, point, normal, face_normal,
                                 tolerance_ + pixel_size * (0.5 + std::min(clear_slope, slope)),
                                 tolerance_ + pixel_size * (0.5 + slope));
  if (front == InFront::something) return trust::none;
  if (front == InFront::perhaps && ray_blocked(point, pixel_size + tolerance_ * (1 + slope)))
    return trust::none;
  return level;
}

bool PhotoSight::ray_blocked(const Eigen::Vector3d& point, double tolerance) const {
  const Eigen::Vector3d towards = camera_.towards_camera(point);
  double way = std::numeric_limits<double>::infinity();
  if (camera_.projection == Camera::Projection::perspective)
    way = (camera_.center() - point).norm() - tolerance;
  return way > 0 && full_->blocked(point + tolerance * towards, towards, way);
}

// Whether any of the pixels round it shows something in front of both planes through the point: the face's
// own and the smoothed one (the face's leans too far where a scan is noisy, the other where it is coarse).
// By the larger tolerance surely, by the smaller one perhaps.
PhotoSight::InFront PhotoSight::in_front(const Camera::Projected& seen, const Eigen::Vector3d& point,
                                         const Eigen::Vector3d& normal, const Eigen::Vector3d& face_normal,
                                         double least_tolerance, double tolerance) const {
  const double scale_x = static_cast<double>(camera_.width) / depth_.width();
  const double scale_y = static_cast<double>(camera_.height) / depth_.height();
  const int left = static_cast<int>(std::floor(seen.pixel.x() / scale_x - 0.5));
  const int top = static_cast<int>(std::floor(seen.pixel.y() / scale_y - 0.5));
  // n . X = n . x in the camera's frame: along the rays of a perspective camera, depth times -n . ray is -n .
  // x; of an orthographic one, the ray gives X and Y. Both are linear in the pixel.
  const Eigen::Vector3d x_in_camera = camera_.camera_from_world * point;
  const bool perspective = camera_.projection == Camera::Projection::perspective;
  const Eigen::Matrix3d ray_of = camera_from_pixel_ * Eigen::Vector3d(scale_x, scale_y, 1).asDiagonal();
  struct Plane {
    Eigen::Vector3d lean;  // by the pixel
    double offset;
    double slope;  // depth counts so much, if orthographic
  };
  const auto plane_of = [&](const Eigen::Vector3d& normal_in_world) {
    const Eigen::Vector3d n = camera_.camera_from_world.linear() * normal_in_world;
    const Eigen::Vector3d by_ray = perspective ? n : Eigen::Vector3d(n.x(), n.y(), 0);
    return Plane{-(ray_of.transpose() * by_ray), -n.dot(x_in_camera), -n.z()};
  };
  InFront found = InFront::nothing;
  const std::array<Plane, 2> planes = {plane_of(normal), plane_of(face_normal)};
  for (int y = std::max(0, top - 1); y <= std::min(top + 2, depth_.height() - 1); ++y)
    for (int x = std::max(0, left - 1); x <= std::min(left + 2, depth_.width() - 1); ++x) {
      const double depth = depth_.at(x, y);
      if (!(depth < seen.depth + tolerance)) continue;  // behind, or nothing there
      const Eigen::Vector3d pixel(x + 0.5, y + 0.5, 1);
      const auto before = [&](const Plane& p, double by) {
        const double lean = p.lean.dot(pixel);
        return perspective ? lean > 0 && (depth + by) * lean < p.offset
                           : p.slope > 0 && (depth + by) * p.slope + lean < p.offset;
      };
      if (!before(planes[0], least_tolerance) || !before(planes[1], least_tolerance)) continue;
      if (before(planes[0], tolerance) && before(planes[1], tolerance)) return InFront::something;
      found = InFront::perhaps;
    }
  return found;
}

Camera depth_camera(const Camera& camera) {
  const int side = std::max(camera.width, camera.height);
  if (side <= largest_depth_map_px) return camera;
  const double factor = static_cast<double>(largest_depth_map_px) / side;
  return camera.resized(std::max(1, static_cast<int>(camera.width * factor)),
                        std::max(1, static_cast<int>(camera.height * factor)));
}

double surface_deviation(const rendering::DepthMap& of_simplified, const TriangleMesh& simplified,
                         const rendering::DepthMap& of_full, const Camera& camera) {
  constexpr double percentile = 0.95;
  constexpr double safety = 3;
  constexpr double most_share = 0.02;
  std::vector<double> distances;
  for (int y = 0; y < of_full.faces.height(); ++y)
    for (int x = 0; x < of_full.faces.width(); ++x) {
      const std::int32_t face = of_simplified.faces.at(x, y);
      if (face == rendering::DepthMap::no_face || of_full.faces.at(x, y) == rendering::DepthMap::no_face)
        continue;
      const double depth = of_simplified.depth.at(x, y);
      const Eigen::Vector3d point = camera.unproject({x + 0.5, y + 0.5}, depth);
      const double cosine = scaled_face_normal(simplified, static_cast<std::size_t>(face))
                                .stableNormalized()
                                .dot(camera.towards_camera(point));
      if (cosine > 0) distances.push_back(cosine * std::abs(depth - of_full.depth.at(x, y)));
    }
  if (distances.empty()) return 0;
  const auto at =
      distances.begin() + static_cast<std::ptrdiff_t>(percentile * static_cast<double>(distances.size() - 1));
  std::nth_element(distances.begin(), at, distances.end());
  return std::min(safety * *at, most_share * bounding_box(simplified.vertices).diagonal().norm());
}

}  // namespace drape::texturing
