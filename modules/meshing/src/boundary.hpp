// Borders as simple loops.
#pragma once

#include <cstdint>
#include <vector>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

struct SimpleLoop {
  std::vector<std::uint32_t> vertices;  // no vertex twice; against the faces' direction, the hole on the left
  bool closed = true;                   // false: the faces round it are inconsistent, and it ends somewhere
};

/// The border of the mesh as loops that pass no vertex twice: where a border touches itself it is split
/// there. In the order of their least vertices, with which they start.
[[nodiscard]] std::vector<SimpleLoop> simple_border_loops(const TriangleMesh& mesh);

}  // namespace drape::meshing
