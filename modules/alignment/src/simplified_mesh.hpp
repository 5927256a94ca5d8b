// A mesh with fewer faces and all but the same outline.
#pragma once

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::alignment {

/// At most about `max_faces` faces, by edge collapses of least quadric error (Garland and Heckbert 1997, as
/// in meshoptimizer); more where the mesh's topology does not allow it. Positions and faces only. A mesh that
/// is small enough is returned as it is.
[[nodiscard]] TriangleMesh simplified_mesh(const TriangleMesh& mesh, int max_faces);

}  // namespace drape::alignment
