// A patch where every smooth one would cut the surface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "hole_patch.hpp"

namespace drape::meshing {

/// The work grows with the cube of a loop's edges: longer ones are not tried.
constexpr std::size_t most_edges_for_least_crossings = 64;

struct LeastCrossingPatch {
  Patch patch;
  std::size_t crossings = 0;  // pairs of faces that cross, of which one is the patch's
};

/// Of all triangulations of a loop of the mesh without new vertices, the one whose triangles cross the fewest
/// of the faces `around` it; of equal ones that of the least area. A loop that runs through the surface has
/// none that crosses nothing. Dynamic programming over the loop's intervals (Barequet and Sharir 1995). No
/// chord is an edge of a face around already; nothing where that allows no triangulation, and of loops longer
/// than most_edges_for_least_crossings. The faces are between vertices of the mesh.
[[nodiscard]] std::optional<LeastCrossingPatch> least_crossing_patch(const TriangleMesh& mesh,
                                                                     const std::vector<std::uint32_t>& loop,
                                                                     const std::vector<Face>& around);

}  // namespace drape::meshing
