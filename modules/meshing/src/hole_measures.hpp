// What a boundary loop looks like.
#pragma once

#include <cstdint>
#include <vector>

#include "drape/geometry/mesh_topology.hpp"
#include "drape/meshing/hole_filling.hpp"
#include "vertex_faces.hpp"

namespace drape::meshing {

/// The plane through a loop's mean point, and its mean normal (unit length, or zero if the loop spans no
/// area).
struct LoopPlane {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // the loop runs counter-clockwise about it
};
[[nodiscard]] LoopPlane loop_plane(const TriangleMesh& mesh, const std::vector<std::uint32_t>& loop);

/// Edges, length, area, flatness and centre of a loop; `action` and `why` are left to others.
[[nodiscard]] Hole measured(const TriangleMesh& mesh, const BoundaryLoop& loop);

/// The edge-connected pieces of a mesh.
class Pieces {
 public:
  explicit Pieces(const TriangleMesh& mesh);
  [[nodiscard]] std::uint32_t of_vertex(std::uint32_t v) const { return of_vertex_[v]; }
  [[nodiscard]] double area(std::uint32_t piece) const { return areas_[piece]; }

 private:
  std::vector<std::uint32_t> of_vertex_;  // where pieces touch in a vertex, the last of them
  std::vector<double> areas_;
};

/// Whether the loop spans so much of its piece (a quarter of its area) that it is the rim of an open sheet,
/// and no hole in it.
[[nodiscard]] bool is_sheet_rim(const Hole& hole, double piece_area);

/// Whether the object was cut or stood there: the loop is flat, its piece lies on one side of it, and meets
/// its plane steeply (45 degrees or more in the mean).
[[nodiscard]] bool is_base(const TriangleMesh& mesh, const VertexFaces& around, const Pieces& pieces,
                           const BoundaryLoop& loop, const Hole& hole, double spacing);

}  // namespace drape::meshing
