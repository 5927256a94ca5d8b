// Vertices where several fans of faces touch in a point.
#pragma once

#include <cstddef>

#include "cleaning.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

[[nodiscard]] std::size_t non_manifold_vertex_count(const TriangleMesh& mesh);

/// Without such vertices: of the fans round one, the largest stays and the faces of the others go, until no
/// such vertex is left. For meshes made of samples, where a touching point is an accident of the sampling.
/// `removed` counts vertices.
[[nodiscard]] Cleaned without_touching_fans(const TriangleMesh& mesh);

/// The same by giving each further fan a vertex of its own (appended): no face is lost. `removed` counts the
/// vertices that were shared.
[[nodiscard]] Cleaned with_parted_fans(const TriangleMesh& mesh);

}  // namespace drape::meshing
