// One sample for each small volume of space.
#pragma once

#include "drape/geometry/point_cloud.hpp"

namespace drape::meshing {

/// Each voxel's samples become their mean (attributes too, normals normalised), in the order of the voxels;
/// samples of opposite normals in one voxel stay apart, so that thin walls keep both sides. Samples that are
/// not finite, or have a normal without direction, are left out. voxel 0: nothing is merged but equal points.
[[nodiscard]] PointCloud merged_on_voxels(const PointCloud& cloud, double voxel);

}  // namespace drape::meshing
