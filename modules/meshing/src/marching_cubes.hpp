// The surface of a fused field in triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "drape/geometry/triangle_mesh.hpp"
#include "fused_field.hpp"
#include "fusion_blocks.hpp"

namespace drape::meshing {

struct FieldSurface {
  TriangleMesh mesh;
  std::vector<std::uint32_t> first_vertex;  // block b made the vertices first_vertex[b] .. [b + 1] - 1
};

/// Marching cubes (Lorensen and Cline 1987) over the cubes of which all eight corners are known, and one
/// in front of the surface by more than a guess. Every edge has at most two faces, and they agree on the
/// outside, which is where the field is positive. A vertex is shared by all cubes round its edge, and at
/// least 2 % of the edge from its ends. Some may have no face.
[[nodiscard]] FieldSurface field_surface(const FusionBlocks& blocks, const FusedField& field);

}  // namespace drape::meshing
