// The order of a mesh's faces and vertices, and which side of it is its outside.
#pragma once

#include <vector>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

/// Vertices by their coordinates, faces by their vertices and each with its least vertex first: the same
/// bytes for the same geometry. Orientations are lost, attributes must not be there yet.
[[nodiscard]] TriangleMesh in_canonical_order(const TriangleMesh& mesh);

/// The mesh with each edge-connected piece consistently oriented, and turned so that the sum of votes[face] *
/// (+1 where the face kept its orientation, -1 where it was turned) is not negative. Where a piece has no
/// consistent orientation (a Moebius strip), faces are dropped until it has one. At most two faces on an
/// edge.
[[nodiscard]] TriangleMesh oriented_by_votes(const TriangleMesh& mesh, const std::vector<double>& votes);

}  // namespace drape::meshing
