#include "drape/meshing/simplify.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "drape/base/error.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/geometry/kd_tree.hpp"
#include "spot_mending.hpp"

namespace drape::meshing {
namespace {

Eigen::Vector3d centroid(const TriangleMesh& mesh, const Face& f) {
  return (mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3;
}

// The library works in floats: about the centre they hold enough digits.
std::vector<float> centered_positions(const TriangleMesh& mesh) {
  const Eigen::Vector3d center = bounding_box(mesh.vertices).center();
  std::vector<float> positions;
  positions.reserve(3 * mesh.vertices.size());
  for (const Eigen::Vector3d& p : mesh.vertices)
    for (int k = 0; k < 3; ++k) positions.push_back(static_cast<float>(p[k] - center[k]));
  return positions;
}

std::vector<std::uint8_t> filled_as_nearest(const TriangleMesh& mesh, const TriangleMesh& made) {
  std::vector<Eigen::Vector3d> centroids;
  centroids.reserve(mesh.faces.size());
  for (const Face& f : mesh.faces) centroids.push_back(centroid(mesh, f));
  const KdTree tree(centroids);
  std::vector<std::uint8_t> filled;
  for (const Face& f : made.faces) {
    Neighbor nearest{};
    tree.nearest(centroid(made, f), {&nearest, 1});
    filled.push_back(mesh.filled[nearest.index]);
  }
  return filled;
}

}  // namespace

TriangleMesh simplified(const TriangleMesh& mesh, const SimplifyLimits& limits) {
  if (const std::string problem = problem_of(mesh); !problem.empty())
    throw input_error("the mesh: {}", problem);
  const bool unlimited = limits.triangles == 0 && limits.error == 0;
  if (unlimited || mesh.faces.size() <= limits.triangles || mesh.empty()) return mesh;
  const std::vector<float> positions = centered_positions(mesh);
  std::vector<unsigned int> indices;
  indices.reserve(3 * mesh.faces.size());
  for (const Face& f : mesh.faces) indices.insert(indices.end(), f.begin(), f.end());
  std::vector<unsigned int> left(indices.size());
  constexpr float any_error = 1.0F;  // relative to the extent of the mesh
  // A quadric holds the mean square distance to the planes of many faces: the farthest place was 2.4 times
  // off that on a torus.
  constexpr double farthest = 2.5;
  const double extent = bounding_box(mesh.vertices).sizes().maxCoeff();
  const float error = limits.error > 0 && extent > 0
                          ? static_cast<float>(std::min(1.0, limits.error / farthest / extent))
                          : any_error;
  left.resize(meshopt_simplify(left.data(), indices.data(), indices.size(), positions.data(),
                               mesh.vertices.size(), 3 * sizeof(float), 3 * limits.triangles, error, 0,
                               nullptr));
  TriangleMesh result = mesh;
  result.faces.clear();
  for (std::size_t i = 0; i + 2 < left.size(); i += 3)
    result.faces.push_back({left[i], left[i + 1], left[i + 2]});
  // The library collapses an edge without a look at all the faces round it: now and then sheets get glued.
  result.filled.clear();
  result = with_spots_mended(result);
  result.filled = mesh.filled.empty() ? std::vector<std::uint8_t>() : filled_as_nearest(mesh, result);
  if (!result.normals.empty()) result.normals = vertex_normals(result);
  return result;
}

}  // namespace drape::meshing
