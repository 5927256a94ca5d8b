#include "drape/simulation/virtual_camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "drape/base/parallel.hpp"
#include "drape/base/random.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "scene.hpp"

namespace drape::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using std::numbers::pi;

constexpr int samples_per_side = 3;  // odd: the middle one is the pixel's centre
constexpr double sun_radius = 0.06;  // radians: as a window or a softbox
constexpr double vignetting = 0.16;  // light lost in the corners
constexpr float exposure = 1.0F;
const Vector3f sun_color(0.95F, 0.90F, 0.80F);

struct CameraRay {
  Vector3d origin;
  Vector3d direction;
};

/// Rays through pixel positions; computed once per camera what does not depend on the pixel.
class RayMaker {
 public:
  explicit RayMaker(const Camera& camera)
      : perspective_(camera.projection == Camera::Projection::perspective),
        image_to_camera_(camera.K.inverse()),
        world_from_camera_(camera.camera_from_world.inverse()) {}

  [[nodiscard]] CameraRay operator()(double x, double y) const {
    const Vector3d in_camera = image_to_camera_ * Vector3d(x, y, 1);
    if (perspective_)
      return {world_from_camera_.translation(), world_from_camera_.linear() * in_camera.normalized()};
    return {world_from_camera_ * Vector3d(in_camera.x(), in_camera.y(), 0),
            world_from_camera_.linear().col(2)};
  }

 private:
  bool perspective_;
  Eigen::Matrix3d image_to_camera_;
  Rigid3 world_from_camera_;
};

/// From the upper left, before the subject.
Vector3d sun_direction(const Scene& scene) {
  return scene.world_from_set() * Vector3d(-0.55, -0.62, 0.95).normalized();
}

/// A direction to one of nine places on the sun's disc, by sample; turned by pixel, so that the shadow's rim
/// has grain and not steps.
Vector3d towards_sun(const Vector3d& sun, int sample, double turn) {
  const double radius = sun_radius * std::sqrt((sample + 0.5) / (samples_per_side * samples_per_side));
  const double around = 2 * pi * (turn + sample * (std::numbers::phi - 1));
  const Vector3d side = sun.unitOrthogonal();
  return (sun + radius * (std::cos(around) * side + std::sin(around) * sun.cross(side))).normalized();
}

/// Lambert's law for the diffuse part, Blinn's highlight (1977) on top; linear radiance.
Vector3f shade(const Scene& scene, const SurfacePoint& point, const Vector3d& towards_eye,
               const Vector3d& sun, const Vector3d& sun_sample) {
  Vector3f light = point.sky_light;
  Vector3f highlight = Vector3f::Zero();
  if (scene.lit_from(point, sun_sample)) {
    light += static_cast<float>(std::max(0.0, point.normal.dot(sun))) * sun_color;
    const double gleam = std::max(0.0, (towards_eye + sun).normalized().dot(point.normal));
    highlight = static_cast<float>(point.gloss * std::pow(gleam, 70)) * sun_color;
  }
  return point.albedo.cwiseProduct(light) + highlight;
}

Vector3f pixel_light(const Scene& scene, const RayMaker& ray_at, int x, int y, const Vector3d& sun,
                     double turn) {
  Vector3f sum = Vector3f::Zero();
  for (int sample = 0; sample < samples_per_side * samples_per_side; ++sample) {
    const CameraRay ray = ray_at(x + (sample % samples_per_side + 0.5) / samples_per_side,
                                 y + (sample / samples_per_side + 0.5) / samples_per_side);
    const auto point = scene.look(ray.origin, ray.direction);
    if (!point) continue;
    sum += shade(scene, *point, -ray.direction, sun, towards_sun(sun, sample, turn)).cwiseMin(1.5F);
  }
  return sum / static_cast<float>(samples_per_side * samples_per_side);
}

/// What the sensor makes of the light, 8 bit and sRGB-encoded.
std::array<std::uint8_t, 3> develop(const Vector3f& light, double noise_percent, Rng& random) {
  Vector3f value = exposure * light;
  for (float& channel : value) {
    // Photon noise, and a floor of dark noise.
    const double sigma = noise_percent / 100 * std::sqrt(std::max(0.02, static_cast<double>(channel)));
    channel += static_cast<float>(sigma * random.normal());
  }
  const Vector3f encoded = srgb_from_linear(value.cwiseMax(0.0F).cwiseMin(1.0F));
  std::array<std::uint8_t, 3> pixel{};
  for (std::size_t k = 0; k < 3; ++k)
    pixel[k] = static_cast<std::uint8_t>(std::lround(255 * encoded[static_cast<Eigen::Index>(k)]));
  return pixel;
}

}  // namespace

Camera camera_round(const TriangleMesh& mesh, int width, int height, double fov_deg, double azimuth_deg,
                    double elevation_deg, double roll_deg, double fill_percent, const Vector2d& off_center) {
  const BoundingBox box = bounding_box(mesh.vertices);
  const double radius = box.diagonal().norm() / 2;
  const double azimuth = azimuth_deg * pi / 180;
  const double elevation = elevation_deg * pi / 180;
  const Vector3d towards_eye(std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
                             std::sin(elevation));
  const double half_angle =
      std::atan(std::tan(fov_deg * pi / 360) * std::min(width, height) / width * fill_percent / 100);
  const double distance = radius / std::sin(half_angle);
  // Straight from above, the picture's top is the far side of azimuth.
  const Vector3d up(-std::cos(azimuth) * std::sin(elevation), -std::sin(azimuth) * std::sin(elevation),
                    std::cos(elevation));
  Camera camera = look_at(box.center() + distance * towards_eye, box.center(), up, width, height, fov_deg);
  const double focal_px = camera.K(0, 0);
  // Turned about its own axis, then aimed beside the object.
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(std::atan(off_center.x() * width / focal_px), Vector3d::UnitY()) *
       Eigen::AngleAxisd(-std::atan(off_center.y() * height / focal_px), Vector3d::UnitX()) *
       Eigen::AngleAxisd(roll_deg * pi / 180, Vector3d::UnitZ()))
          .toRotationMatrix();
  camera.camera_from_world = Rigid3(turn * camera.camera_from_world);
  return camera;
}

SimulatedPhoto take_photo(const Subject& subject, const Camera& camera, const PhotoStyle& style,
                          const Progress& progress) {
  const Scene scene(subject, camera, style);
  const RayMaker ray_at(camera);
  const Vector3d sun = sun_direction(scene);
  SimulatedPhoto photo{Image8(camera.width, camera.height, 3),
                       Image8(camera.width, camera.height, 1, stencil::background), camera};
  const double corner = std::hypot(camera.width, camera.height) / 2;
  const auto expose_row = [&](int y) {
    for (int x = 0; x < camera.width; ++x) {
      Rng random(
          item_seed(style.seed, static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(camera.width) +
                                    static_cast<std::uint64_t>(x)));
      const double from_middle =
          std::hypot(x + 0.5 - camera.width / 2.0, y + 0.5 - camera.height / 2.0) / corner;
      const double kept = 1 - vignetting * from_middle * from_middle;
      const Vector3f light =
          static_cast<float>(kept) * pixel_light(scene, ray_at, x, y, sun, random.uniform());
      const auto pixel = develop(light, style.noise_percent, random);
      for (int k = 0; k < 3; ++k) photo.image.at(x, y, k) = pixel[static_cast<std::size_t>(k)];
      const CameraRay ray = ray_at(x + 0.5, y + 0.5);
      if (scene.sees_subject(ray.origin, ray.direction)) photo.stencil.at(x, y) = stencil::object;
    }
  };
  constexpr int band = 64;
  for (int first = 0; first < camera.height; first += band) {
    progress.update(static_cast<double>(first) / camera.height, "photo");
    const int rows = std::min(band, camera.height - first);
    parallel_for(static_cast<std::size_t>(rows), 2, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row) expose_row(first + static_cast<int>(row));
    });
  }
  return photo;
}

}  // namespace drape::simulation
