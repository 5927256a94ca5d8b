#include "test_cameras.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "drape/base/random.hpp"

namespace drape::rendering {

Camera random_camera(std::uint64_t seed, Camera::Projection projection, double distance, int width,
                     int height) {
  Rng rng(seed);
  const Eigen::Vector3d from(rng.normal(), rng.normal(), rng.normal());
  const Eigen::Vector3d up(rng.normal(), rng.normal(), rng.normal());
  const Eigen::Vector3d target(rng.uniform(-0.05, 0.05), rng.uniform(-0.05, 0.05), rng.uniform(-0.05, 0.05));
  Camera camera = look_at(distance * from.normalized(), target, up, width, height, 40);
  camera.projection = projection;
  const double size_px = 0.36 * std::min(width, height);  // of the unit radius
  const double focal = projection == Camera::Projection::perspective ? size_px * distance : size_px;
  camera.K << focal * rng.uniform(0.9, 1.1), 0.05 * focal * rng.uniform(-1, 1),
      width * rng.uniform(0.47, 0.53), 0.03 * focal * rng.uniform(-1, 1), focal * rng.uniform(0.9, 1.1),
      height * rng.uniform(0.47, 0.53), 0, 0, 1;
  return camera;
}

double distance_to_hull(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& pixel) {
  // A side of the hull has all points on one side; the signed distance to a convex region is at least the
  // largest of those to its sides, and equal to it within.
  double distance = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& a : points)
    for (const Eigen::Vector2d& b : points) {
      const Eigen::Vector2d along = (b - a).normalized();
      if (!((b - a).norm() > 1e-9)) continue;
      const Eigen::Vector2d outward(along.y(), -along.x());
      const bool side = std::all_of(points.begin(), points.end(),
                                    [&](const Eigen::Vector2d& c) { return outward.dot(c - a) < 1e-9; });
      if (side) distance = std::max(distance, outward.dot(pixel - a));
    }
  return distance;
}

}  // namespace drape::rendering
