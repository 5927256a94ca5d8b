// What the scans say of a fused surface besides its shape.
#pragma once

#include <span>

#include "depth_map.hpp"
#include "drape/geometry/range_scan.hpp"
#include "fusion_blocks.hpp"
#include "marching_cubes.hpp"

namespace drape::meshing {

/// Colours, intensities and confidences of the surface's vertices, where all scans have them: the mean of
/// what the scans that see the vertex have there, by their weight in its distance.
void fuse_attributes(FieldSurface& surface, const FusionBlocks& blocks, std::span<const DepthMap> maps,
                     std::span<const RangeScan> scans);

}  // namespace drape::meshing
