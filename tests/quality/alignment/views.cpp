#include "views.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "drape/base/random.hpp"

namespace drape::lab {
namespace {

constexpr double radians = std::numbers::pi / 180;

Camera turned(const Camera& camera, double about_z) {
  Camera result = camera;
  result.camera_from_world = camera.camera_from_world * Eigen::AngleAxisd(about_z, Eigen::Vector3d::UnitZ());
  return result;
}

}  // namespace

Camera random_view(const Ball& ball, const Lens& lens, std::uint64_t seed, double off_center) {
  Rng rng(seed);
  const Eigen::Quaterniond rotation(rng.normal(), rng.normal(), rng.normal(), rng.normal());
  const double fov = rng.uniform(lens.least_fov_deg, lens.most_fov_deg) * radians;
  const double half = photo_px / 2.0;
  const double size_px = rng.uniform(0.5, 0.9) * half;  // of the radius
  const Eigen::Vector2d place(half + rng.uniform(-1, 1) * (half - size_px),
                              half + rng.uniform(-1, 1) * (half - size_px));
  const double direction = rng.uniform(0, 2 * std::numbers::pi);
  const Eigen::Vector2d principal =
      Eigen::Vector2d(half, half) +
      off_center * photo_px * Eigen::Vector2d(std::cos(direction), std::sin(direction));
  const bool perspective = lens.projection == Camera::Projection::perspective;
  Camera camera;
  camera.projection = lens.projection;
  camera.width = camera.height = photo_px;
  const double focal_px = perspective ? half / std::tan(fov / 2) : size_px / ball.radius;
  camera.K << focal_px, 0, principal.x(), 0, focal_px, principal.y(), 0, 0, 1;
  const double depth = perspective ? focal_px * ball.radius / size_px : 2 * ball.radius;
  const Eigen::Vector2d aside = (place - principal) / focal_px * (perspective ? depth : 1);
  camera.camera_from_world.linear() = rotation.normalized().toRotationMatrix();
  camera.camera_from_world.translation() << aside, depth;
  camera.camera_from_world.translation() -= camera.camera_from_world.linear() * ball.center;
  return camera;
}

metrics::CameraError error_modulo_symmetry(const Camera& found, const Camera& truth, const Model& model) {
  const Eigen::Vector3d center = ball_about(model.object).center;
  metrics::CameraError best = metrics::camera_error(found, truth, center);
  if (!model.symmetry.about_z) return best;
  // Coarse, then by ever finer steps about the best turn.
  double at = 0;
  for (double step = 10 * radians; step > 1e-4 * radians; step /= 5) {
    const double middle = at;
    const int count = step > 5 * radians ? 18 : 6;
    for (int i = -count; i <= count; ++i) {
      const double turn = middle + i * step;
      const metrics::CameraError error = metrics::camera_error(found, turned(truth, turn), center);
      if (error.rotation_about_ray_deg >= best.rotation_about_ray_deg) continue;
      best = error;
      at = turn;
    }
  }
  return best;
}

}  // namespace drape::lab
