#include "simplified_mesh.hpp"

#include <meshoptimizer.h>

#include <limits>

#include "drape/geometry/bounding_box.hpp"

namespace drape::alignment {

TriangleMesh simplified_mesh(const TriangleMesh& mesh, int max_faces) {
  TriangleMesh result;
  result.vertices = mesh.vertices;
  result.faces = mesh.faces;
  const auto target = static_cast<std::size_t>(max_faces);
  if (mesh.faces.size() <= target) return result;

  // Floats about the middle of the mesh.
  const Eigen::Vector3d center = bounding_box(mesh.vertices).center();
  std::vector<Eigen::Vector3f> positions;
  positions.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& x : mesh.vertices) positions.push_back((x - center).cast<float>());

  std::vector<unsigned int> indices;
  indices.reserve(3 * mesh.faces.size());
  for (const Face& face : mesh.faces) indices.insert(indices.end(), face.begin(), face.end());
  std::vector<unsigned int> kept(indices.size());
  const std::size_t count = meshopt_simplify(
      kept.data(), indices.data(), indices.size(), positions.front().data(), positions.size(),
      sizeof(Eigen::Vector3f), 3 * target, std::numeric_limits<float>::max(), 0, nullptr);
  result.faces.clear();
  for (std::size_t i = 0; i + 2 < count; i += 3) result.faces.push_back({kept[i], kept[i + 1], kept[i + 2]});
  return without_unused_vertices(result);
}

}  // namespace drape::alignment
