// Patches for all the holes of a mesh.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "drape/base/progress.hpp"
#include "drape/geometry/triangle_mesh.hpp"
#include "drape/meshing/hole_filling.hpp"
#include "seen_space.hpp"

namespace drape::meshing {

/// How a patch is to be made: tangent to the surface round it, as a plain triangulation of its loop, or as a
/// planar cap. Less where that is not possible.
enum class PatchStyle { smooth, plain, flat };

struct LoopToFill {
  std::vector<std::uint32_t> loop;  // closed and simple, the hole on its left
  PatchStyle style = PatchStyle::smooth;
};

struct Patched {
  struct Hole {
    HoleAction action = HoleAction::leave;
    std::string how;        // in words
    std::size_t faces = 0;  // added
  };
  TriangleMesh mesh;
  std::vector<Hole> holes;    // as the loops
  std::size_t crossings = 0;  // self-intersections with added faces
};

/// No patch stands in space that was seen through.
struct SpaceToKeep {
  const SeenSpace& seen;
  double spacing;
};

/// The mesh and after its vertices and faces those of a patch for each loop. New vertices have attributes
/// blended from the loop's, and confidence 0.
[[nodiscard]] Patched with_patches(const TriangleMesh& mesh, const std::vector<LoopToFill>& loops,
                                   const SpaceToKeep* keep, const Progress& progress);

}  // namespace drape::meshing
