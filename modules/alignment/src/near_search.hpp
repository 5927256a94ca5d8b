// A pose that fits nearly is often next to one that fits.
#pragma once

#include <vector>

#include "pose_search.hpp"

namespace drape::alignment {

/// Poses about `about`, a few degrees off in each direction and under a longer and a shorter lens, refined as
/// those of the search are. Nearly the same outline seen from further away, or a flat side seen just on edge,
/// holds a refinement fast beside the pose that it should have found. Best first; not all are distinct.
[[nodiscard]] std::vector<RefinedPose> search_near(const OutlinePose& about, const MeshLevels& meshes,
                                                   const Evidence& evidence, const LensPrior& lens,
                                                   const Progress& progress);

}  // namespace drape::alignment
