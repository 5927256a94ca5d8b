// Which faces lie side by side.
#pragma once

#include <cstdint>
#include <vector>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::texturing {

/// Two faces, first < second, with the edge low < high between them.
struct FaceEdge {
  std::uint32_t first;
  std::uint32_t second;
  std::uint32_t low;
  std::uint32_t high;
};

/// In the order of their edges. Of an edge with more than two faces, each and the next.
[[nodiscard]] std::vector<FaceEdge> face_edges(const TriangleMesh& mesh);

}  // namespace drape::texturing
