// What lies round a hole.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hole_patch.hpp"
#include "vertex_faces.hpp"

namespace drape::meshing {

/// The boundary and two rings of faces round it, cut out of the mesh. Nothing where a boundary edge has not
/// exactly one face.
[[nodiscard]] std::optional<HoleRegion> hole_region(const TriangleMesh& mesh, const VertexFaces& around,
                                                    const std::vector<std::uint32_t>& loop);

}  // namespace drape::meshing
