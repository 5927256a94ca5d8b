// Holes with something inside.
#pragma once

#include <cstddef>
#include <vector>

#include "drape/geometry/mesh_topology.hpp"
#include "hole_measures.hpp"

namespace drape::meshing {

/// For each loop the number of the loop that it lies in, or its own number. A loop lies in another if, seen
/// along that one's normal, it runs the other way round inside it, and is an island (the rim of another
/// piece, near the hole) or in the same plane (the inner rim of a hollow base).
[[nodiscard]] std::vector<std::size_t> loops_around(const TriangleMesh& mesh, const Pieces& pieces,
                                                    const std::vector<BoundaryLoop>& loops,
                                                    const std::vector<Hole>& holes, double spacing);

/// One simple loop that runs along both, and the two faces of the bridge between them where they are closest.
struct BridgedLoop {
  std::vector<std::uint32_t> loop;
  std::vector<Face> bridge;
};
/// The loops share no vertex.
[[nodiscard]] BridgedLoop bridged(const TriangleMesh& mesh, const std::vector<std::uint32_t>& outer,
                                  const std::vector<std::uint32_t>& inner);

}  // namespace drape::meshing
