// Fewer triangles for the same shape.
#pragma once

#include <cstddef>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

/// At most `triangles` faces, or as few as can be reached without changing the topology, by quadric edge
/// collapse (Garland and Heckbert 1997, meshoptimizer). The vertices are some of the mesh's own, with their
/// bits and attributes; normals are computed anew where the mesh has them; a face is `filled` where the
/// nearest face of the mesh is. The same mesh if it has no more faces than asked for.
[[nodiscard]] TriangleMesh simplified(const TriangleMesh& mesh, std::size_t triangles);

}  // namespace drape::meshing
