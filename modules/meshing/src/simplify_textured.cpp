#include <meshoptimizer.h>

#include <cstdint>
#include <vector>

#include "drape/geometry/bounding_box.hpp"
#include "drape/meshing/simplify.hpp"

namespace drape::meshing {
namespace {

// A vertex as the faces on one side of a seam have it.
struct Corner {
  std::uint32_t vertex = 0;
  std::uint32_t material = 0;
  Eigen::Vector2f uv = Eigen::Vector2f::Zero();
};

struct Corners {
  std::vector<Corner> corners;
  std::vector<unsigned int> indices;  // three per face
};

Corners corners_of(const TexturedMesh& model) {
  Corners result;
  std::vector<std::vector<std::uint32_t>> of_vertex(model.mesh.vertices.size());
  for (std::size_t f = 0; f < model.mesh.faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner corner{model.mesh.faces[f][k], model.face_materials[f], model.corner_uvs[f][k]};
      std::vector<std::uint32_t>& known = of_vertex[corner.vertex];
      std::uint32_t index = static_cast<std::uint32_t>(result.corners.size());
      for (const std::uint32_t other : known)
        if (result.corners[other].material == corner.material && result.corners[other].uv == corner.uv)
          index = other;
      if (index == result.corners.size()) {
        known.push_back(index);
        result.corners.push_back(corner);
      }
      result.indices.push_back(index);
    }
  return result;
}

// The library works in floats: about the centre they hold enough digits.
std::vector<float> centered_positions(const TriangleMesh& mesh, const Corners& corners) {
  const Eigen::Vector3d center = bounding_box(mesh.vertices).center();
  std::vector<float> positions;
  positions.reserve(3 * corners.corners.size());
  for (const Corner& corner : corners.corners)
    for (int k = 0; k < 3; ++k)
      positions.push_back(static_cast<float>(mesh.vertices[corner.vertex][k] - center[k]));
  return positions;
}

}  // namespace

TexturedMesh simplified(const TexturedMesh& model, std::size_t triangles) {
  if (triangles == 0 || model.mesh.faces.size() <= triangles) return model;
  const Corners corners = corners_of(model);
  const std::vector<float> positions = centered_positions(model.mesh, corners);
  std::vector<unsigned int> left(corners.indices.size());
  constexpr float any_error = 1.0F;  // relative to the extent of the mesh
  left.resize(meshopt_simplify(left.data(), corners.indices.data(), corners.indices.size(), positions.data(),
                               corners.corners.size(), 3 * sizeof(float), 3 * triangles, any_error, 0,
                               nullptr));
  TexturedMesh result = model;
  result.mesh.faces.clear();
  result.mesh.filled.clear();
  result.corner_uvs.clear();
  result.face_materials.clear();
  for (std::size_t i = 0; i + 2 < left.size(); i += 3) {
    // A face's corners have one material: edges are collapsed along seams, never across them.
    const Corner& a = corners.corners[left[i]];
    const Corner& b = corners.corners[left[i + 1]];
    const Corner& c = corners.corners[left[i + 2]];
    result.mesh.faces.push_back({a.vertex, b.vertex, c.vertex});
    result.corner_uvs.push_back({a.uv, b.uv, c.uv});
    result.face_materials.push_back(a.material);
  }
  result.mesh = without_unused_vertices(result.mesh);
  if (!result.mesh.normals.empty()) result.mesh.normals = vertex_normals(result.mesh);
  return result;
}

}  // namespace drape::meshing
