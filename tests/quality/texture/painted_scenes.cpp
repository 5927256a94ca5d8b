#include "painted_scenes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "drape/base/parallel.hpp"
#include "drape/base/random.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/simulation/virtual_camera.hpp"

namespace drape::lab {
namespace {

constexpr double field_of_view_deg = 38;

}  // namespace

float linear(float stored) {
  return stored <= 0.04045F ? stored / 12.92F : std::pow((stored + 0.055F) / 1.055F, 2.4F);
}

std::uint8_t byte(float light) {
  const float v = std::clamp(light, 0.F, 1.F);
  const float stored = v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1 / 2.4F) - 0.055F;
  return static_cast<std::uint8_t>(std::lround(255 * stored));
}

Scene seen_by(const Object& object, const Camera& camera) {
  Scene scene{camera, Image<float>(width, height, 3, 0), Image<float>(width, height, 1, 0),
              Image8(width, height, 1, stencil::background)};
  parallel_for(height, 8, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < width; ++x)
        for (int s = 0; s < 9; ++s) {
          const Eigen::Vector2d pixel(x + (s % 3 + 0.5) / 3, y + (s / 3 + 0.5) / 3);
          const Eigen::Vector3d eye = camera.center();
          const Eigen::Vector3d direction = camera.unproject(pixel, 1) - eye;
          const auto hit = object.caster.first_hit(eye, direction);
          if (!hit) continue;
          if (s == 4) scene.stencil.at(x, y) = stencil::object;
          const Eigen::Vector3f color =
              simulation::object_color(object.spec, eye + hit->distance * direction);
          for (int c = 0; c < 3; ++c) scene.light.at(x, y, c) += linear(color[c]) / 9;
          scene.coverage.at(x, y) += 1 / 9.F;
        }
  });
  return scene;
}

Photo photographed(const Scene& scene, const Eigen::Vector3f& background, double exposure, std::uint64_t seed,
                   double noise) {
  Photo photo{Image8(width, height, 3), scene.stencil, scene.camera};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      Rng rng(item_seed(seed, static_cast<std::uint64_t>(y * width + x)));
      for (int c = 0; c < 3; ++c) {
        const float light = scene.light.at(x, y, c) + (1 - scene.coverage.at(x, y)) * background[c];
        photo.rgb.at(x, y, c) =
            byte(static_cast<float>(exposure) * light + static_cast<float>(noise * rng.normal()));
      }
    }
  return photo;
}

double turn_deg(std::uint64_t seed) {
  return seed == 0 ? 0 : 360 * Rng(item_seed(501, seed)).uniform();
}

Camera camera_at(const Object& object, double azimuth_deg, double elevation_deg) {
  return simulation::camera_round(object.mesh, width, height, field_of_view_deg, azimuth_deg, elevation_deg);
}

Camera slightly_off(const Object& object, const Camera& camera, const CameraError& error,
                    std::uint64_t seed) {
  Rng rng(seed);
  const Eigen::Vector3d middle = camera.camera_from_world * bounding_box(object.mesh.vertices).center();
  const Eigen::Vector3d axis = Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
  const double zoom = 1 + error.focal_percent / 100 * rng.normal();
  const Eigen::AngleAxisd turn(error.turn_deg * std::numbers::pi / 180, axis);
  Camera off = camera;
  off.K(0, 0) *= zoom;
  off.K(1, 1) *= zoom;
  off.camera_from_world = Eigen::Translation3d(Eigen::Vector3d(middle.x(), middle.y(), zoom * middle.z())) *
                          turn * Eigen::Translation3d(-middle) * camera.camera_from_world;
  return off;
}

Scene without_background(Scene scene) {
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float& coverage = scene.coverage.at(x, y);
      if (!(coverage > 0)) continue;
      for (int c = 0; c < 3; ++c) scene.light.at(x, y, c) /= coverage;
      coverage = 1;
    }
  return scene;
}

}  // namespace drape::lab
