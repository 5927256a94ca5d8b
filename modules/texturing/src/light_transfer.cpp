#include "light_transfer.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "drape/base/parallel.hpp"
#include "drape/geometry/barycentric.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/rendering/shadow_map.hpp"

namespace drape::texturing {
namespace {

using Eigen::Vector3d;

constexpr int direction_count = 128;
constexpr int map_side = 512;

// Of a unit vector.
Eigen::Matrix<float, 9, 1> harmonics(const Vector3d& d) {
  Eigen::Matrix<double, 9, 1> y;
  y << 0.282095, 0.488603 * d.y(), 0.488603 * d.z(), 0.488603 * d.x(), 1.092548 * d.x() * d.y(),
      1.092548 * d.y() * d.z(), 0.315392 * (3 * d.z() * d.z() - 1), 1.092548 * d.x() * d.z(),
      0.546274 * (d.x() * d.x() - d.y() * d.y());
  return y.cast<float>();
}

// Where transfers are reckoned: vertices, and corners whose face leans away from its neighbours.
struct Entry {
  Vector3d point;
  Vector3d normal;
};

}  // namespace

const std::vector<Vector3d>& LightTransfer::directions() {
  // Spherical Fibonacci lattice (Keinert et al. 2015).
  static const std::vector<Vector3d> all = [] {
    std::vector<Vector3d> d;
    for (int i = 0; i < direction_count; ++i) {
      const double z = 1 - (2 * i + 1.0) / direction_count;
      const double around = 2 * std::numbers::pi * i * (std::numbers::phi - 1);
      const double r = std::sqrt(1 - z * z);
      d.emplace_back(r * std::cos(around), r * std::sin(around), z);
    }
    return d;
  }();
  return all;
}

LightTransfer::LightTransfer(const TriangleMesh& mesh, rendering::Renderer& renderer,
                             std::span<const SurfacePlace> places, const Progress& progress)
    : mesh_(mesh) {
  const double crease_cosine = std::cos(0.5);  // as SurfaceNormals has it
  const std::vector<Eigen::Vector3f> smooth = vertex_normals(mesh);
  std::vector<Entry> where;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    where.push_back({mesh.vertices[v], smooth[v].cast<double>()});
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Vector3d normal = scaled_face_normal(mesh, f).stableNormalized();
    auto& corners = corner_entries_.emplace_back(mesh.faces[f]);
    for (std::uint32_t& corner : corners) {
      if (where[corner].normal.dot(normal) >= crease_cosine) continue;
      where.push_back({where[corner].point, normal});
      corner = static_cast<std::uint32_t>(where.size() - 1);
    }
  }
  entries_.assign(where.size(), Transfer::Zero());
  const BoundingBox box = bounding_box(mesh.vertices);
  constexpr float solid_angle_over_pi = 4.F / direction_count;
  for (std::size_t d = 0; d < directions().size(); ++d) {
    progress.update(static_cast<double>(d) / direction_count, "looking where light arrives");
    const Vector3d& towards = directions()[d];
    const rendering::ShadowMap map(renderer, box, towards, map_side);
    const Eigen::Matrix<float, 9, 1> light = solid_angle_over_pi * harmonics(towards);
    parallel_for(where.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto cosine = static_cast<float>(where[i].normal.dot(towards));
        if (!(cosine > 0)) continue;
        const float lit = map.lit(where[i].point, where[i].normal);
        entries_[i].head<9>() += cosine * lit * light;
        entries_[i][9] += cosine * (1 - lit) * solid_angle_over_pi;
      }
    });
    std::vector<std::uint8_t>& reached = lit_places_.emplace_back(places.size());
    parallel_for(places.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        reached[i] = static_cast<std::uint8_t>(std::lround(255 * map.lit(places[i].point, places[i].normal)));
    });
  }
}

Transfer LightTransfer::at(std::uint32_t face, const Vector3d& point) const {
  const Eigen::Vector3f weights =
      barycentric_weights(mesh_, face, point).cwiseMax(0.0).cwiseMin(1.0).cast<float>();
  const auto& corners = corner_entries_[face];
  return (weights[0] * entries_[corners[0]] + weights[1] * entries_[corners[1]] +
          weights[2] * entries_[corners[2]]) /
         std::max(weights.sum(), 1e-6F);
}

}  // namespace drape::texturing
