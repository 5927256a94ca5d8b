// Making a mesh smaller where it stands.
#pragma once

#include "drape/geometry/triangle_mesh.hpp"

namespace drape {

/// The same as without_unused_vertices without a second mesh, for those that fill much of the memory.
void drop_unused_vertices(TriangleMesh& mesh);

}  // namespace drape
