#include "lit_photo.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "drape/base/random.hpp"
#include "drape/rendering/renderer.hpp"

namespace drape::lab {
namespace {

constexpr double least_cosine = 0.75;  // between a face and its corners' normals: else it is an edge

struct Light {
  Eigen::Vector3d towards;  // in camera axes
  double lamp;
  double ambient;
  double gloss;

  [[nodiscard]] double at(const Eigen::Vector3d& normal) const {
    const Eigen::Vector3d half = (towards - Eigen::Vector3d::UnitZ()).normalized();
    return ambient * (1 - 0.3 * normal.y()) + lamp * std::max(0.0, normal.dot(towards)) +
           gloss * std::pow(std::max(0.0, normal.dot(half)), 20);
  }
};

Light random_light(Rng& rng) {
  // The camera looks along +z: a lamp on its side has negative z.
  Eigen::Vector3d towards(rng.normal(), rng.normal(), rng.normal());
  towards.z() = -std::abs(towards.z()) - 0.2;
  return {towards.normalized(), rng.uniform(0.4, 0.7), rng.uniform(0.1, 0.3), rng.uniform(0, 0.15)};
}

// Weights of the corners at a point in the triangle's plane.
Eigen::Vector3d weights_of(const Eigen::Vector3d& x, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                           const Eigen::Vector3d& c) {
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const double area = normal.squaredNorm();
  if (!(area > 0)) return {1, 0, 0};
  return Eigen::Vector3d((c - b).cross(x - b).dot(normal), (a - c).cross(x - c).dot(normal),
                         (b - a).cross(x - a).dot(normal)) /
         area;
}

std::uint8_t byte(double value) {
  return static_cast<std::uint8_t>(std::clamp(std::lround(255 * value), 0L, 255L));
}

struct Surface {
  Eigen::Vector3d normal;  // towards the camera, in its axes
  Eigen::Vector3d paint;
};

Surface surface_at(const TriangleMesh& object, const std::vector<Eigen::Vector3f>& normals,
                   const Camera& camera, const std::array<std::uint32_t, 3>& face, const Eigen::Vector3d& x) {
  const Eigen::Vector3d& a = object.vertices[face[0]];
  const Eigen::Vector3d& b = object.vertices[face[1]];
  const Eigen::Vector3d& c = object.vertices[face[2]];
  const Eigen::Vector3d weights = weights_of(x, a, b, c);
  const Eigen::Vector3d flat = (b - a).cross(c - a).normalized();
  Eigen::Vector3d smooth = Eigen::Vector3d::Zero();
  Surface surface{{0, 0, 0}, {0, 0, 0}};
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t corner = face[static_cast<std::size_t>(k)];
    const Eigen::Vector3d normal = normals[corner].cast<double>();
    smooth += weights[k] * (normal.dot(flat) > least_cosine ? normal : flat);
    if (!object.colors.empty()) surface.paint += weights[k] * object.colors[corner].cast<double>();
  }
  const bool away = flat.dot(camera.towards_camera(x)) < 0;
  surface.normal = camera.camera_from_world.linear() * smooth.normalized() * (away ? -1 : 1);
  return surface;
}

}  // namespace

Image8 lit_photo(const TriangleMesh& object, const Camera& camera, bool painted, std::uint64_t seed) {
  Rng rng(seed);
  const Light light = random_light(rng);
  const Eigen::Vector3d grey = Eigen::Vector3d::Constant(rng.uniform(0.5, 0.9));
  const Eigen::Vector2d ramp(rng.uniform(0.1, 0.9), rng.uniform(-0.2, 0.2));
  const rendering::DepthMap seen = rendering::Renderer(object).depth_map(camera);
  const std::vector<Eigen::Vector3f> normals = vertex_normals(object);
  Image8 photo(camera.width, camera.height, 3);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const std::int32_t face = seen.faces.at(x, y);
      Eigen::Vector3d color = Eigen::Vector3d::Constant(ramp[0] + ramp[1] * x / camera.width);
      if (face != rendering::DepthMap::no_face) {
        const Surface surface =
            surface_at(object, normals, camera, object.faces[static_cast<std::size_t>(face)],
                       camera.unproject({x + 0.5, y + 0.5}, seen.depth.at(x, y)));
        color = light.at(surface.normal) * (painted && !object.colors.empty() ? surface.paint : grey);
      }
      const double noise = 0.02 * rng.normal();
      for (int k = 0; k < 3; ++k) photo.at(x, y, k) = byte(color[k] + noise);
    }
  return photo;
}

}  // namespace drape::lab
