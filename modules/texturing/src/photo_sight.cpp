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
// Seen more obliquely, a surface recedes within a pixel by more than the gap behind what hides it just so,
// and the pixels round a point may all lie behind its plane: where they do not lie on it, a ray decides.
constexpr double surely_told_cosine = 0.5;
constexpr int most_plain_pixels = 4096;  // of the depth picture, looked at for one triangle

// Tangent of the incidence.
double slope_of(double cosine) {
  return std::min(steepest_slope, std::sqrt(std::max(0.0, 1 - cosine * cosine)) / cosine);
}

}  // namespace

PhotoSight::PhotoSight(const Camera& camera, OutlineWarp warp, ImageF depth, Image8 trusted, double tolerance,
                       double max_incidence_deg, const RayCaster& full)
    : camera_(camera),
      warp_(std::move(warp)),
      depth_(std::move(depth)),
      ray_of_depth_pixel_(camera.K.inverse() *
                          Eigen::Vector3d(static_cast<double>(camera.width) / std::max(1, depth_.width()),
                                          static_cast<double>(camera.height) / std::max(1, depth_.height()),
                                          1)
                              .asDiagonal()),
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
  const Eigen::Vector3d towards = camera_.towards_camera(point);
  const double cosine = normal.dot(towards);
  if (!(cosine >= least_cosine_)) return trust::none;
  const std::uint8_t level = trust_at(warp_(seen.pixel));
  if (level == trust::none) return trust::none;
  // A pixel of the depth map tells the depth within its own width only: the steeper the surface, the less
  // exactly.
  const double pixel_size = pixel_size_at(seen.depth);
  const double slope = slope_of(cosine);
  const InFront front = in_front(seen, point, normal, face_normal, least_tolerance_at(pixel_size, cosine),
                                 tolerance_ + pixel_size * (0.5 + slope),
                                 std::min(cosine, face_normal.dot(towards)) < surely_told_cosine);
  if (front == InFront::something) return trust::none;
  if (front == InFront::perhaps && blocked(point, cosine)) return trust::none;
  return level;
}

bool PhotoSight::blocked(const Eigen::Vector3d& point, double cosine) const {
  const double tolerance = pixel_size_at(camera_.project(point).depth) + tolerance_ * (1 + slope_of(cosine));
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
                                         double least_tolerance, double tolerance, bool oblique) const {
  InFront found = InFront::nothing;
  const std::array<Plane, 2> planes = {plane_of(point, normal), plane_of(point, face_normal)};
  const DepthPixels round = pixels_round(seen.pixel, seen.pixel);
  for (int y = round.top; y < round.bottom; ++y)
    for (int x = round.left; x < round.right; ++x) {
      const double depth = depth_.at(x, y);
      if (oblique && !is_on(planes[0], x, y, depth, least_tolerance) &&
          !is_on(planes[1], x, y, depth, least_tolerance))
        found = InFront::perhaps;
      if (!(depth < seen.depth + tolerance)) continue;  // behind, or nothing there
      if (!is_before(planes[0], x, y, depth + least_tolerance) ||
          !is_before(planes[1], x, y, depth + least_tolerance))
        continue;
      if (is_before(planes[0], x, y, depth + tolerance) && is_before(planes[1], x, y, depth + tolerance))
        return InFront::something;
      found = InFront::perhaps;
    }
  return found;
}

bool PhotoSight::sees_plainly(const std::array<Eigen::Vector3d, 3>& corners,
                              const std::array<Camera::Projected, 3>& projected,
                              const std::array<Eigen::Vector3d, 3>& normals,
                              const Eigen::Vector3d& face_normal) const {
  const bool perspective = camera_.projection == Camera::Projection::perspective;
  Eigen::AlignedBox2d box;
  Eigen::AlignedBox2d looked_up;
  double nearest = std::numeric_limits<double>::infinity();
  std::array<Eigen::Vector3d, 3> towards;
  for (std::size_t k = 0; k < 3; ++k) {
    if (perspective && !(projected[k].depth > 0)) return false;
    nearest = std::min(nearest, projected[k].depth);
    box.extend(projected[k].pixel);
    looked_up.extend(warp_(projected[k].pixel));
    towards[k] = camera_.towards_camera(corners[k]);
  }
  // Between the corners, normals and directions lean no farther apart than at them.
  double least = 1;
  double most = 0;
  for (const Eigen::Vector3d& n : normals)
    for (const Eigen::Vector3d& t : towards) {
      const double cosine = n.dot(t);
      least = std::min(least, cosine);
      most = std::max(most, cosine);
    }
  if (!(least >= least_cosine_)) return false;
  constexpr double bend_px = 1;  // of a warp, between the corners
  if (warp_.moves()) {
    looked_up.min().array() -= bend_px;
    looked_up.max().array() += bend_px;
  }
  if (!(looked_up.min().minCoeff() >= 0 && looked_up.max().x() < camera_.width &&
        looked_up.max().y() < camera_.height && holds(box.min()) && holds(box.max())))
    return false;
  const DepthPixels round = pixels_round(box.min(), box.max());
  if ((round.right - round.left) * (round.bottom - round.top) > most_plain_pixels) return false;
  for (int y = static_cast<int>(looked_up.min().y()); y <= static_cast<int>(looked_up.max().y()); ++y)
    for (int x = static_cast<int>(looked_up.min().x()); x <= static_cast<int>(looked_up.max().x()); ++x)
      if (trusted_.at(x, y) != trust::full) return false;
  const double tolerance = least_tolerance_at(pixel_size_at(nearest), std::min(1.0, most));
  const Plane plane = plane_of(corners[0], face_normal);
  for (const Eigen::Vector3d& t : towards) least = std::min(least, face_normal.dot(t));
  const bool oblique = least < surely_told_cosine;
  for (int y = round.top; y < round.bottom; ++y)
    for (int x = round.left; x < round.right; ++x) {
      const double depth = depth_.at(x, y);
      if (oblique ? !is_on(plane, x, y, depth, tolerance) : is_before(plane, x, y, depth + tolerance))
        return false;
    }
  return true;
}

PhotoSight::Plane PhotoSight::plane_of(const Eigen::Vector3d& point,
                                       const Eigen::Vector3d& normal_in_world) const {
  // n . X = n . x in the camera's frame: along the rays of a perspective camera, depth times -n . ray is -n .
  // x; of an orthographic one, the ray gives X and Y. Both are linear in the pixel.
  const Eigen::Vector3d n = camera_.camera_from_world.linear() * normal_in_world;
  const bool perspective = camera_.projection == Camera::Projection::perspective;
  const Eigen::Vector3d by_ray = perspective ? n : Eigen::Vector3d(n.x(), n.y(), 0);
  return {-(ray_of_depth_pixel_.transpose() * by_ray), -n.dot(camera_.camera_from_world * point), -n.z()};
}

// Whether what is at that depth in a pixel lies in front of the plane.
bool PhotoSight::is_before(const Plane& p, int x, int y, double depth) const {
  const double lean = p.lean.x() * (x + 0.5) + p.lean.y() * (y + 0.5) + p.lean.z();
  return camera_.projection == Camera::Projection::perspective
             ? lean > 0 && depth * lean < p.offset
             : p.slope > 0 && depth * p.slope + lean < p.offset;
}

bool PhotoSight::is_on(const Plane& plane, int x, int y, double depth, double tolerance) const {
  return is_before(plane, x, y, depth - tolerance) && !is_before(plane, x, y, depth + tolerance);
}

// Those that bilinear filtering blends anywhere in a box of photo pixels, and one more on each side.
PhotoSight::DepthPixels PhotoSight::pixels_round(const Eigen::Vector2d& least,
                                                 const Eigen::Vector2d& most) const {
  const double scale_x = static_cast<double>(camera_.width) / depth_.width();
  const double scale_y = static_cast<double>(camera_.height) / depth_.height();
  const auto first = [](double at, double scale) { return static_cast<int>(std::floor(at / scale - 0.5)); };
  return {std::max(0, first(least.x(), scale_x) - 1), std::max(0, first(least.y(), scale_y) - 1),
          std::min(depth_.width(), first(most.x(), scale_x) + 3),
          std::min(depth_.height(), first(most.y(), scale_y) + 3)};
}

// Of the depth picture, in space.
double PhotoSight::pixel_size_at(double depth) const {
  const double pixels_per_unit = std::sqrt(std::abs(camera_.K(0, 0) * camera_.K(1, 1)));
  return (camera_.projection == Camera::Projection::perspective ? depth : 1.0) / pixels_per_unit *
         camera_.width / depth_.width();
}

// What is in front by less is nothing for sure.
double PhotoSight::least_tolerance_at(double pixel_size, double cosine) const {
  return tolerance_ + pixel_size * (0.5 + std::min(clear_slope, slope_of(cosine)));
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
