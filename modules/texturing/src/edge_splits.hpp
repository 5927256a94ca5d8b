// A mesh whose edges are cut at given points, each on both of its sides.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::texturing {

/// A point on the edge between two vertices, low < high: low + share * (high - low), 0 < share < 1.
struct EdgeSplit {
  std::uint32_t low;
  std::uint32_t high;
  double share;
};

struct SplitMesh {
  TriangleMesh mesh;
  std::vector<std::uint32_t> parents;  // per face, the face of the mesh before that it is part of
};

/// Cuts every edge named at its point in all faces that have it, so that no vertex lies on another face's
/// edge. Of several splits of one edge the first counts. Vertices keep their numbers; new ones follow, with
/// attributes interpolated (colours in linear light). Faces stay in their parents' order and turn the same
/// way.
[[nodiscard]] SplitMesh split_edges(const TriangleMesh& mesh, std::span<const EdgeSplit> splits);

}  // namespace drape::texturing
