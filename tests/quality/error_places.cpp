#include "error_places.hpp"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>

#include "drape/base/random.hpp"
#include "drape/geometry/kd_tree.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "drape/geometry/ray_caster.hpp"
#include "drape/metrics/surface_distance.hpp"

namespace drape::test {
namespace {

using Eigen::Vector3d;

constexpr std::size_t places = 50000;

struct Place {
  Vector3d point;
  double error = 0;  // signed, in spacings
  double from_border = std::numeric_limits<double>::infinity();
  double from_crease = std::numeric_limits<double>::infinity();
  int views = 0;
};

// Points along the edges where the surface bends by more than 30 degrees.
std::vector<Vector3d> crease_points(const TriangleMesh& mesh, double step) {
  std::map<std::array<std::uint32_t, 2>, Vector3d> normals;
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(mesh.faces[i][k], mesh.faces[i][(k + 1) % 3]);
      const Vector3d normal = scaled_face_normal(mesh, i).normalized();
      const auto [there, is_new] = normals.emplace(std::array{low, high}, normal);
      if (is_new || there->second.dot(normal) > std::cos(std::numbers::pi / 6)) continue;
      const Vector3d along = mesh.vertices[high] - mesh.vertices[low];
      const int steps = 1 + static_cast<int>(along.norm() / step);
      for (int s = 0; s <= steps; ++s) points.push_back(mesh.vertices[low] + along * s / steps);
    }
  return points;
}

std::vector<Vector3d> border_points(const TriangleMesh& mesh) {
  std::vector<Vector3d> points;
  for (const BoundaryLoop& loop : boundary_loops(mesh))
    for (const std::uint32_t v : loop.vertices) points.push_back(mesh.vertices[v]);
  return points;
}

std::vector<Place> measured_places(const TriangleMesh& made, const TriangleMesh& truth,
                                   const std::vector<Rigid3>& world_from_scanner, double spacing) {
  const std::vector<Vector3d> points = spread_points(made, places, 1).positions;
  const std::vector<double> distances = metrics::distances_to_surface(points, truth);
  const auto [true_points, true_faces] = spread_points(truth, 400000, 1);
  const std::vector<Vector3d> border = border_points(made);
  const std::vector<Vector3d> creases = crease_points(truth, spacing / 2);
  const KdTree to_truth(true_points);
  const KdTree to_border(border);
  const KdTree to_crease(creases);
  const RayCaster caster(truth);
  std::vector<Place> result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Neighbor nearest{};
    to_truth.nearest(points[i], {&nearest, 1});
    const Vector3d normal = scaled_face_normal(truth, true_faces[nearest.index]).normalized();
    Place place{points[i], distances[i] / spacing, 1e9, 1e9, 0};
    if (normal.dot(points[i] - true_points[nearest.index]) < 0) place.error = -place.error;
    Neighbor other{};
    if (to_border.nearest(points[i], {&other, 1}) > 0)
      place.from_border = std::sqrt(other.squared_distance) / spacing;
    if (to_crease.nearest(points[i], {&other, 1}) > 0)
      place.from_crease = std::sqrt(other.squared_distance) / spacing;
    for (const Rigid3& scanner : world_from_scanner) {
      const Vector3d from = true_points[nearest.index] + 1e-3 * spacing * normal;
      const Vector3d to_scanner = scanner.translation() - from;
      if (normal.dot(to_scanner.normalized()) < std::cos(75 * std::numbers::pi / 180)) continue;
      if (!caster.first_hit(from, to_scanner.normalized())) ++place.views;
    }
    result.push_back(place);
  }
  return result;
}

template <class Is>
void print_places(const std::string& name, const std::vector<Place>& all, Is is) {
  double count = 0;
  double squares = 0;
  double sum = 0;
  double all_squares = 0;
  for (const Place& place : all) {
    all_squares += place.error * place.error;
    if (!is(place)) continue;
    count += 1;
    squares += place.error * place.error;
    sum += place.error;
  }
  if (count == 0) return;
  fmt::print("      {:<28} {:>5.1f} % of the surface, {:>5.1f} % of the squares, RMS {:.3f}, mean {:+.3f}\n",
             name, 100 * count / static_cast<double>(all.size()), 100 * squares / all_squares,
             std::sqrt(squares / count), sum / count);
}

}  // namespace

SurfacePoints spread_points(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed) {
  std::vector<double> area(mesh.faces.size() + 1, 0);
  for (std::size_t i = 0; i < mesh.faces.size(); ++i)
    area[i + 1] = area[i] + scaled_face_normal(mesh, i).norm();
  Rng random(seed);
  SurfacePoints result;
  for (std::size_t i = 0; i < count; ++i) {
    const auto face = static_cast<std::size_t>(
        std::upper_bound(area.begin() + 1, area.end() - 1, random.uniform() * area.back()) - area.begin() -
        1);
    const Face& f = mesh.faces[face];
    const double a = std::sqrt(random.uniform());
    const double b = random.uniform();
    result.positions.push_back((1 - a) * mesh.vertices[f[0]] + a * (1 - b) * mesh.vertices[f[1]] +
                               a * b * mesh.vertices[f[2]]);
    result.faces.push_back(face);
  }
  return result;
}

void print_error_places(const TriangleMesh& made, const TriangleMesh& truth,
                        const std::vector<Rigid3>& world_from_scanner, double spacing) {
  const std::vector<Place> all = measured_places(made, truth, world_from_scanner, spacing);
  const std::array<double, 6> limits{0, 1, 2, 4, 8, 1e10};
  for (std::size_t i = 0; i + 1 < limits.size(); ++i) {
    const auto between = [&, i](double d) { return d >= limits[i] && d < limits[i + 1]; };
    const std::string range = fmt::format("{}-{} from", limits[i], limits[i + 1]);
    print_places(range + " the border", all, [&](const Place& p) { return between(p.from_border); });
    print_places(range + " a crease", all, [&](const Place& p) { return between(p.from_crease); });
  }
  for (int views = 0; views <= 6; ++views)
    print_places(fmt::format("seen by {}", views), all, [&](const Place& p) { return p.views == views; });
  print_places("4 off crease and border", all,
               [](const Place& p) { return p.from_crease > 4 && p.from_border > 4; });
}

}  // namespace drape::test
