// Smoothing that keeps edges and creases.
#pragma once

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

/// Bilateral filtering of the face normals, and vertices that follow them (Zheng, Fu, Au and Tai, "Bilateral
/// normal filtering for mesh denoising", 2011, the local scheme; vertex update of Sun et al., 2007). Vertices
/// on borders stay where they are. The mesh's normals, if it has any, are computed anew. `rounds` >= 0.
[[nodiscard]] TriangleMesh smoothed(const TriangleMesh& mesh, int rounds);

}  // namespace drape::meshing
