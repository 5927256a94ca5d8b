// Patches for all the holes of a mesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "drape/base/progress.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

struct Patched {
  struct Hole {
    std::string how;        // in words; empty where the loop's faces do not allow for a patch
    std::size_t faces = 0;  // added
  };
  TriangleMesh mesh;
  std::vector<Hole> holes;    // as the loops
  std::size_t crossings = 0;  // self-intersections with added faces
};

/// Where patches begin: tangent to the surface round them, or as plain triangulations of their loop.
enum class PatchStyle { smooth, plain };

/// The mesh and after its vertices and faces those of a patch for each loop (closed, simple, the hole on its
/// left). New vertices have attributes blended from the loop's, and confidence 0.
[[nodiscard]] Patched with_patches(const TriangleMesh& mesh,
                                   const std::vector<std::vector<std::uint32_t>>& loops, PatchStyle style,
                                   const Progress& progress);

}  // namespace drape::meshing
