// What the scans say of a fused surface besides its shape.
#pragma once

#include <span>

#include "depth_map.hpp"
#include "drape/geometry/range_scan.hpp"
#include "fusion_blocks.hpp"
#include "marching_cubes.hpp"

namespace drape::meshing {

/// What all scans have.
struct CommonAttributes {
  bool colors = true;
  bool intensities = true;
  bool confidences = true;

  [[nodiscard]] bool any() const { return colors || intensities || confidences; }
};

[[nodiscard]] CommonAttributes common_attributes(std::span<const DepthMap> maps,
                                                 std::span<const RangeScan> scans);

/// Those attributes for the vertices of a part: the mean of what the scans that see the vertex have there, by
/// their weight in its distance.
void fuse_attributes(SurfacePart& part, const CommonAttributes& common, const FusionBlocks& blocks,
                     std::span<const DepthMap> maps, std::span<const RangeScan> scans);

}  // namespace drape::meshing
