// Sampled shapes of which everything is known.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "drape/base/random.hpp"
#include "drape/geometry/point_cloud.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::test {

/// About evenly spread samples on a sphere (a Fibonacci spiral), `spacing` apart, moved along their normals
/// by normal noise.
inline PointCloud sampled_sphere(double radius, double spacing, double noise = 0,
                                 const Eigen::Vector3d& center = Eigen::Vector3d::Zero()) {
  PointCloud cloud;
  const auto count = static_cast<std::size_t>(4 * std::numbers::pi * radius * radius / (spacing * spacing));
  Rng rng(11);
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1 - 2 * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    const double around = static_cast<double>(i) * std::numbers::pi * (3 - std::sqrt(5.0));
    const double r = std::sqrt(1 - z * z);
    const Eigen::Vector3d n(r * std::cos(around), r * std::sin(around), z);
    cloud.positions.push_back(center + (radius + noise * rng.normal()) * n);
    cloud.normals.push_back(n.cast<float>());
  }
  return cloud;
}

inline PointCloud sampled_torus(double major_radius, double minor_radius, double spacing) {
  PointCloud cloud;
  const int minor_steps = static_cast<int>(2 * std::numbers::pi * minor_radius / spacing);
  for (int j = 0; j < minor_steps; ++j) {
    const double v = 2 * std::numbers::pi * j / minor_steps;
    const double r = major_radius + minor_radius * std::cos(v);
    const int steps = static_cast<int>(2 * std::numbers::pi * r / spacing);
    for (int i = 0; i < steps; ++i) {
      const double u = 2 * std::numbers::pi * (i + 0.5 * (j % 2)) / steps;
      const Eigen::Vector3d n(std::cos(v) * std::cos(u), std::cos(v) * std::sin(u), std::sin(v));
      cloud.positions.emplace_back(r * std::cos(u), r * std::sin(u), minor_radius * std::sin(v));
      cloud.normals.push_back(n.cast<float>());
    }
  }
  return cloud;
}

/// The six sides of a box about the origin, edges left out by half a spacing.
inline PointCloud sampled_box(const Eigen::Vector3d& half, double spacing) {
  PointCloud cloud;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      for (double a = -half[u] + spacing / 2; a < half[u]; a += spacing)
        for (double b = -half[v] + spacing / 2; b < half[v]; b += spacing) {
          Eigen::Vector3d p;
          p[axis] = side * half[axis];
          p[u] = a;
          p[v] = b;
          Eigen::Vector3f n = Eigen::Vector3f::Zero();
          n[axis] = static_cast<float>(side);
          cloud.positions.push_back(p);
          cloud.normals.push_back(n);
        }
    }
  return cloud;
}

/// The greatest |distance(p)| over vertices, edge midpoints and centroids of the faces.
template <class Distance>
double worst_distance(const TriangleMesh& mesh, Distance distance) {
  double worst = 0;
  for (const Face& f : mesh.faces) {
    const Eigen::Vector3d& a = mesh.vertices[f[0]];
    const Eigen::Vector3d& b = mesh.vertices[f[1]];
    const Eigen::Vector3d& c = mesh.vertices[f[2]];
    for (const Eigen::Vector3d& p : {a, b, c, Eigen::Vector3d((a + b) / 2), Eigen::Vector3d((b + c) / 2),
                                     Eigen::Vector3d((c + a) / 2), Eigen::Vector3d((a + b + c) / 3)})
      worst = std::max(worst, std::abs(distance(p)));
  }
  return worst;
}

/// The mesh without the faces that `drop` holds for, by their centroid.
template <class Drop>
TriangleMesh with_hole(const TriangleMesh& mesh, Drop drop) {
  std::vector<std::uint8_t> keep;
  for (const Face& f : mesh.faces)
    keep.push_back(
        drop(Eigen::Vector3d((mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3)) ? 0 : 1);
  return with_faces(mesh, keep);
}

}  // namespace drape::test
