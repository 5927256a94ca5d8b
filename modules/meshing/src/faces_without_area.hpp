// Faces whose corners lie on one line.
#pragma once

#include "cleaning.hpp"

namespace drape::meshing {

/// Without faces that have no area: two corners in one place become one vertex, and one that lies on the
/// opposite edge parts the face beyond that edge. The surface stays where it is, closed where it was closed.
/// `mesh` is manifold, and stays so: a face stays where that could not be. `removed` counts faces.
[[nodiscard]] Cleaned without_faces_without_area(const TriangleMesh& mesh);

}  // namespace drape::meshing
