// Whether two triangles cross.
#pragma once

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

/// Whether triangles between vertices of the mesh meet elsewhere than in a shared vertex or edge: alike ones
/// do, and ones folded flat onto each other; one without area crosses nothing. Exact predicates (CGAL).
[[nodiscard]] bool faces_cross(const TriangleMesh& mesh, Face f, Face g);

}  // namespace drape::meshing
