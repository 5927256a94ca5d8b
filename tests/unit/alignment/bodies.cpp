#include "bodies.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "drape/rendering/renderer.hpp"
#include "support.hpp"

namespace drape::alignment {
namespace {

constexpr double radians = std::numbers::pi / 180;

void append(TriangleMesh& mesh, const TriangleMesh& part) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (const Face& f : part.faces) mesh.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
}

}  // namespace

TriangleMesh knobbed_brick() {
  TriangleMesh mesh = test::box({-1, -0.6, -0.35}, {1, 0.6, 0.35});
  append(mesh, test::sphere(0.32, 8, {0.8, 0.75, 0.2}));
  append(mesh, test::box({-0.9, -0.2, 0.35}, {-0.5, 0.3, 1.0}));
  return mesh;
}

Camera view_of(const Eigen::Vector3d& euler_deg, double unit_px, double cx, double cy,
               Camera::Projection projection, double fov_deg) {
  Camera camera;
  camera.projection = projection;
  camera.width = 160;
  camera.height = 120;
  const bool perspective = projection == Camera::Projection::perspective;
  const double focal_px = perspective ? camera.width / 2.0 / std::tan(fov_deg * radians / 2) : unit_px;
  camera.K << focal_px, 0, camera.width / 2.0, 0, focal_px, camera.height / 2.0, 0, 0, 1;
  camera.camera_from_world.linear() = (Eigen::AngleAxisd(euler_deg.z() * radians, Eigen::Vector3d::UnitZ()) *
                                       Eigen::AngleAxisd(euler_deg.y() * radians, Eigen::Vector3d::UnitY()) *
                                       Eigen::AngleAxisd(euler_deg.x() * radians, Eigen::Vector3d::UnitX()))
                                          .toRotationMatrix();
  const double depth = perspective ? focal_px / unit_px : 5;
  const double per_px = perspective ? depth / focal_px : 1 / unit_px;
  camera.camera_from_world.translation() << (cx - camera.width / 2.0) * per_px,
      (cy - camera.height / 2.0) * per_px, depth;
  return camera;
}

Image8 stencil_of(const TriangleMesh& mesh, const Camera& camera) {
  return rendering::Renderer(mesh).stencil(camera);
}

Image8 wavy(const Image8& stencil, double amplitude) {
  Image8 result(stencil.width(), stencil.height(), 1, stencil::background);
  for (int y = 0; y < stencil.height(); ++y)
    for (int x = 0; x < stencil.width(); ++x) {
      const double shift = amplitude * std::sin(y / 4.0) * std::sin(x / 23.0 + 1);
      const int from = std::clamp(x + static_cast<int>(std::lround(shift)), 0, stencil.width() - 1);
      result.at(x, y) = stencil.at(from, y);
    }
  return result;
}

double rotation_between_deg(const Camera& a, const Camera& b) {
  return Eigen::AngleAxisd(a.camera_from_world.linear() * b.camera_from_world.linear().transpose()).angle() /
         radians;
}

Image8 lit_photo(const TriangleMesh& mesh, const Camera& camera) {
  const rendering::DepthMap seen = rendering::Renderer(mesh).depth_map(camera);
  const Eigen::Vector3d towards = Eigen::Vector3d(-0.5, -0.6, -0.8).normalized();
  Image8 photo(camera.width, camera.height, 3, 60);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const std::int32_t face = seen.faces.at(x, y);
      if (face == rendering::DepthMap::no_face) continue;
      Eigen::Vector3d normal = camera.camera_from_world.linear() *
                               scaled_face_normal(mesh, static_cast<std::size_t>(face)).normalized();
      if (normal.z() > 0) normal = -normal;
      for (int k = 0; k < 3; ++k)
        photo.at(x, y, k) = static_cast<std::uint8_t>(50 + 180 * std::max(0.0, normal.dot(towards)));
    }
  return photo;
}

}  // namespace drape::alignment
