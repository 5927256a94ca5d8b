// Cutting out what makes a mesh no surface, and closing the cuts.
#pragma once

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

/// The mesh with every edge on at most two faces, of opposite directions, and every vertex in one fan:
/// pockets of two faces back to back go, the faces on wrong edges are cut out and the holes that this makes
/// get plain patches; what still touches in a point is parted. Borders that were there stay open. Unused
/// vertices go.
[[nodiscard]] TriangleMesh with_spots_mended(const TriangleMesh& mesh);

}  // namespace drape::meshing
