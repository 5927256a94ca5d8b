#include "drape/simulation/studio.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "drape/base/parallel.hpp"
#include "drape/base/random.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "scene.hpp"

namespace drape::simulation {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using std::numbers::pi;

constexpr int samples_per_side = 2;
constexpr int lamp_cells = 2;   // per side of a lamp, for each sample of a pixel
constexpr int bounce_rays = 6;  // for each sample of a pixel
constexpr double lift = 1e-6;   // of the object's size: off the surface that a ray starts from

struct Point {
  Vector3d position;
  Vector3d normal;  // unit, on the side that is seen
  Vector3f albedo;  // linear
};

class StudioScene {
 public:
  StudioScene(const Subject& subject, const RayCaster& caster, const Studio& studio)
      : subject_(subject), caster_(caster), studio_(studio) {
    const BoundingBox box = bounding_box(subject.mesh.vertices);
    middle_ = box.center();
    floor_ = box.min().z();
    lift_ = lift * box.diagonal().norm();
    normals_ = subject.mesh.normals.empty() ? vertex_normals(subject.mesh) : subject.mesh.normals;
  }

  [[nodiscard]] std::optional<Point> on_object(const Vector3d& origin, const Vector3d& direction) const {
    const auto hit = caster_.first_hit(origin, direction);
    if (!hit) return std::nullopt;
    Point point{origin + hit->distance * direction, Vector3d::Zero(), Vector3f::Zero()};
    const Face& face = subject_.mesh.faces[hit->face];
    Vector3f stored = Vector3f::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const double weight = hit->weights[static_cast<Eigen::Index>(k)];
      point.normal += weight * normals_[face[k]].cast<double>();
      if (!subject_.mesh.colors.empty()) stored += static_cast<float>(weight) * subject_.mesh.colors[face[k]];
    }
    if (subject_.normal) point.normal = subject_.normal(point.position);
    if (subject_.color) stored = subject_.color(point.position);
    point.normal.normalize();
    const Vector3d flat = scaled_face_normal(subject_.mesh, hit->face);
    if (flat.dot(direction) > 0) point.normal = -point.normal;
    point.albedo = linear_from_srgb(stored);
    return point;
  }

  /// Radiance times pi that leaves the point.
  [[nodiscard]] Vector3f light_from(const Point& point, Rng& rng) const {
    Vector3f light = lamps_at(point, lamp_cells, rng);
    Vector3f bounced = Vector3f::Zero();
    for (int i = 0; i < bounce_rays; ++i) bounced += seen_along(point, cosine_direction(point, i, rng), rng);
    return point.albedo.cwiseProduct(light + bounced / bounce_rays);
  }

 private:
  // Malley's method: a disc's points lifted to the hemisphere go with the cosine.
  static Vector3d cosine_direction(const Point& point, int stratum, Rng& rng) {
    const double r2 = (stratum + rng.uniform()) / bounce_rays;
    const double around = 2 * pi * rng.uniform();
    const Vector3d side = point.normal.unitOrthogonal();
    return std::sqrt(r2) * (std::cos(around) * side + std::sin(around) * point.normal.cross(side)) +
           std::sqrt(1 - r2) * point.normal;
  }

  [[nodiscard]] Vector3f lamps_at(const Point& point, int cells, Rng& rng) const {
    Vector3f light = Vector3f::Zero();
    const Vector3d start = point.position + lift_ * point.normal;
    for (const StudioLamp& lamp : studio_.lamps) {
      const Vector3d facing = (middle_ - lamp.center).normalized();
      const double reference = (middle_ - lamp.center).squaredNorm();
      const Vector3d u = facing.unitOrthogonal();
      const Vector3d v = facing.cross(u);
      double sum = 0;
      for (int i = 0; i < cells * cells; ++i) {
        const double a = ((i % cells) + rng.uniform()) / cells - 0.5;
        const double b = ((i / cells) + rng.uniform()) / cells - 0.5;
        const Vector3d way = lamp.center + lamp.side * (a * u + b * v) - start;
        const Vector3d towards = way.normalized();
        const double cosines = std::max(0.0, towards.dot(point.normal)) * std::max(0.0, -towards.dot(facing));
        if (cosines > 0 && !caster_.blocked(start, way, 1)) sum += cosines * reference / way.squaredNorm();
      }
      light += static_cast<float>(sum / (cells * cells)) * lamp.power;
    }
    return light;
  }

  // Radiance times pi that comes along a ray: from the object, the floor, or the room.
  [[nodiscard]] Vector3f seen_along(const Point& from, const Vector3d& direction, Rng& rng) const {
    const Vector3d start = from.position + lift_ * from.normal;
    std::optional<Point> hit = on_object(start, direction);
    if (!hit && direction.z() < 0)
      hit = Point{start + (floor_ - start.z()) / direction.z() * direction, Vector3d::UnitZ(),
                  studio_.floor_albedo};
    if (!hit) return studio_.around;
    return hit->albedo.cwiseProduct(lamps_at(*hit, 1, rng));
  }

  const Subject& subject_;
  const RayCaster& caster_;
  const Studio& studio_;
  std::vector<Vector3f> normals_;
  Vector3d middle_;
  double floor_ = 0;
  double lift_ = 0;
};

// Reinhard's shoulder ("Photographic tone reproduction for digital images", 2002, equation 4, white at 4) and
// the contrast of a film's toe.
float film(float x) {
  const float bright = 1.8F * std::max(x, 0.F);
  return std::pow(std::min(1.F, bright * (1 + bright / 16) / (1 + bright)), 1.2F);
}

void put(Image8& image, int x, int y, const Vector3f& linear) {
  const Vector3f stored = srgb_from_linear(linear.cwiseMax(0.F).cwiseMin(1.F));
  for (int c = 0; c < 3; ++c) image.at(x, y, c) = static_cast<std::uint8_t>(std::lround(255 * stored[c]));
}

}  // namespace

Studio random_studio(const TriangleMesh& mesh, std::uint64_t seed) {
  Rng rng(seed);
  const BoundingBox box = bounding_box(mesh.vertices);
  const double size = box.diagonal().norm() / 2;
  Studio studio;
  studio.seed = seed;
  const auto lamp = [&](double brightness) {
    const double azimuth = rng.uniform(0, 2 * pi);
    const double elevation = rng.uniform(20, 70) * pi / 180;
    const double distance = size * rng.uniform(3, 6);
    const Vector3d towards(std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
                           std::sin(elevation));
    const auto warmth = static_cast<float>(rng.uniform(-0.12, 0.12));
    studio.lamps.push_back({box.center() + distance * towards, distance * rng.uniform(0.1, 0.6),
                            static_cast<float>(brightness) * Vector3f(1 + warmth, 1, 1 - warmth)});
  };
  lamp(rng.uniform(0.7, 1.0));
  lamp(rng.uniform(0.1, 0.3));
  studio.around = static_cast<float>(rng.uniform(0.12, 0.3)) * Vector3f(0.95F, 1, 1.05F);
  studio.floor_albedo = Vector3f::Constant(static_cast<float>(rng.uniform(0.1, 0.5)));
  return studio;
}

StudioPhoto take_studio_photo(const Subject& subject, const RayCaster& caster, const Camera& camera,
                              const Studio& studio) {
  const StudioScene scene(subject, caster, studio);
  StudioPhoto photo{Image8(camera.width, camera.height, 3), Image8(camera.width, camera.height, 3),
                    Image8(camera.width, camera.height, 1, stencil::background), camera};
  const auto ray = [&](double x, double y) {
    const Vector3d at = camera.unproject({x, y}, 1);
    const bool perspective = camera.projection == Camera::Projection::perspective;
    return std::pair(perspective ? camera.center() : camera.unproject({x, y}, 0),
                     perspective ? Vector3d(at - camera.center()) : Vector3d(-camera.towards_camera(at)));
  };
  parallel_for(static_cast<std::size_t>(camera.height), 4, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < camera.width; ++x) {
        Rng rng(
            item_seed(studio.seed, static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(camera.width) +
                                       static_cast<std::uint64_t>(x)));
        Vector3f light = Vector3f::Zero();
        Vector3f paint = Vector3f::Zero();
        constexpr int samples = samples_per_side * samples_per_side;
        for (int s = 0; s < samples; ++s) {
          const auto [origin, direction] = ray(x + (s % samples_per_side + 0.5) / samples_per_side,
                                               y + (s / samples_per_side + 0.5) / samples_per_side);
          const auto point = scene.on_object(origin, direction);
          if (!point) continue;
          light += scene.light_from(*point, rng) / samples;
          paint += point->albedo / samples;
        }
        for (float& channel : light) {
          channel = film(studio.exposure * channel);
          // Photon noise, and a floor of dark noise.
          const double sigma =
              studio.noise_percent / 100 * std::sqrt(std::max(0.02, static_cast<double>(channel)));
          channel += static_cast<float>(sigma * rng.normal());
        }
        const auto [origin, direction] = ray(x + 0.5, y + 0.5);
        if (caster.first_hit(origin, direction)) photo.stencil.at(x, y) = stencil::object;
        if (paint.maxCoeff() > 0) put(photo.image, x, y, light);
        put(photo.paint, x, y, paint);
      }
  });
  return photo;
}

}  // namespace drape::simulation
