// Faces and pieces that a mesh is better off without.
#pragma once

#include <cstddef>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

struct Cleaned {
  TriangleMesh mesh;
  std::size_t removed = 0;
};

/// Without faces that name a vertex twice or repeat an earlier face (in either orientation).
[[nodiscard]] Cleaned without_bad_faces(const TriangleMesh& mesh);

/// Without pairs of faces over the same vertices in opposite orientations: a closed surface stays closed.
[[nodiscard]] Cleaned without_flat_pockets(const TriangleMesh& mesh);

/// Without edge-connected pieces that hold less than `percent` of all faces; the largest always stays.
/// `removed` counts pieces.
[[nodiscard]] Cleaned without_small_components(const TriangleMesh& mesh, double percent);

/// Without faces that hang on a ragged border by one edge, `rounds` times.
[[nodiscard]] Cleaned without_border_teeth(const TriangleMesh& mesh, int rounds);

/// Border vertices with exactly the same coordinates become the first of them. `removed` counts vertices.
[[nodiscard]] Cleaned with_joined_borders(const TriangleMesh& mesh);

}  // namespace drape::meshing
