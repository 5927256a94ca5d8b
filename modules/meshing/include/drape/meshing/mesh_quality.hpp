// Figures that say how sound a mesh is.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

struct MeshQuality {
  std::size_t vertices = 0;
  std::size_t faces = 0;
  std::size_t components = 0;
  std::size_t boundary_loops = 0;  // simple ones
  std::size_t borders = 0;         // the same with loops that touch counted as one
  std::size_t boundary_edges = 0;
  std::size_t non_manifold_edges = 0;     // with more than two faces
  std::size_t non_manifold_vertices = 0;  // where several fans of faces touch
  std::size_t inconsistent_edges = 0;     // with two faces of opposite orientation
  std::size_t degenerate_faces = 0;       // without area
  std::size_t self_intersections = 0;     // pairs of faces that cross
  std::optional<long> genus;              // summed over the pieces; of manifold, consistently oriented meshes
  std::optional<double> volume;           // of closed ones; negative if inside out
  double area = 0;
  double median_edge = 0;

  [[nodiscard]] bool manifold() const {
    return non_manifold_edges == 0 && non_manifold_vertices == 0 && inconsistent_edges == 0;
  }
  [[nodiscard]] bool closed() const { return manifold() && boundary_edges == 0; }
};

/// Error{input} if the mesh breaks its promises (problem_of).
[[nodiscard]] MeshQuality mesh_quality(const TriangleMesh& mesh);

using FacePair = std::pair<std::uint32_t, std::uint32_t>;

/// Pairs (lesser, greater) of faces that meet elsewhere than in a shared vertex or edge, sorted. With
/// `tested` (one per face) only pairs with a face for which it is not 0. Exact predicates (CGAL).
[[nodiscard]] std::vector<FacePair> self_intersecting_pairs(const TriangleMesh& mesh,
                                                            const std::vector<std::uint8_t>& tested = {});

}  // namespace drape::meshing
