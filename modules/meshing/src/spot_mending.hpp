// Cutting out what makes a mesh no surface, and closing the cuts.
#pragma once

#include <cstddef>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

/// The mesh with every edge on at most two faces, of opposite directions, and every vertex in one fan:
/// pockets of two faces back to back go, the faces on wrong edges are cut out and the holes that this makes
/// get plain patches; what still touches in a point is parted. Borders that were there stay open. Unused
/// vertices go.
[[nodiscard]] TriangleMesh with_spots_mended(const TriangleMesh& mesh);

struct Uncrossed {
  TriangleMesh mesh;
  std::size_t found = 0;  // pairs of faces that crossed
  std::size_t left = 0;   // that could not be mended: the surface runs through itself there
};

/// Where faces cross, they and a ring of faces round them are cut out, and what that opens gets plain
/// patches; up to three rings. `mesh` is manifold, and so is the outcome. Borders that were there stay open.
[[nodiscard]] Uncrossed with_crossings_mended(const TriangleMesh& mesh);

}  // namespace drape::meshing
