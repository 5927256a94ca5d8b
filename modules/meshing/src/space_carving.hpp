// A closed surface round what no scan saw to be empty.
#pragma once

#include <span>

#include "depth_map.hpp"
#include "drape/base/progress.hpp"
#include "drape/geometry/triangle_mesh.hpp"
#include "fused_field.hpp"
#include "fusion_blocks.hpp"

namespace drape::meshing {

struct CarvedSpace {
  FusionBlocks blocks;  // all in the box of the open surface, and a layer round them
  FusedField field;     // known at every voxel
};

/// The fused field where it is known; elsewhere a voxel is outside if a scan saw through it to a surface
/// behind, or saw nothing along its line of sight, and inside if none did (Curless and Levoy 1996, section
/// 4). No return is evidence only within the picture of the scan's samples, and where no vertex of `open` is
/// seen: dark and grazing surfaces return nothing too. What lies outside of the box of `open` is outside.
/// Error {input} where that box has more than four million blocks of voxels.
[[nodiscard]] CarvedSpace carved_space(const FusionBlocks& blocks, const FusedField& field,
                                       std::span<const DepthMap> maps, const TriangleMesh& open,
                                       const Progress& progress);

}  // namespace drape::meshing
