// How the triangles of a mesh hang together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape {

/// A closed vertex sequence along edges that have one face, against the direction of these faces: the hole is
/// on its left. No vertex comes twice.
struct BoundaryLoop {
  std::vector<std::uint32_t> vertices;
  bool closed = true;  // false: the faces round it are inconsistent, and it ends somewhere
};

/// The border as simple loops: where it touches itself in a vertex it is split there. In the order of their
/// least vertices, with which they start.
[[nodiscard]] std::vector<BoundaryLoop> boundary_loops(const TriangleMesh& mesh);

/// Per face, the number of the edge-connected component that it is in: 0, 1, ... in the order of their first
/// faces.
[[nodiscard]] std::vector<std::uint32_t> face_components(const TriangleMesh& mesh);

struct MeshTopology {
  std::size_t edges = 0;
  std::size_t boundary_edges = 0;      // with one face
  std::size_t non_manifold_edges = 0;  // with more than two faces
  std::size_t inconsistent_edges = 0;  // with two faces that run along it in the same direction
  std::size_t components = 0;
  std::size_t boundary_loops = 0;  // simple ones
  std::size_t borders = 0;         // the same with loops that touch counted as one
  std::size_t unused_vertices = 0;
  /// Vertices minus edges plus faces, unused vertices left out.
  std::ptrdiff_t euler_characteristic = 0;

  [[nodiscard]] bool closed_manifold() const {
    return boundary_edges == 0 && non_manifold_edges == 0 && inconsistent_edges == 0;
  }
};

[[nodiscard]] MeshTopology mesh_topology(const TriangleMesh& mesh);

}  // namespace drape
