// Of many refined poses those that are the body seen differently.
#pragma once

#include <cstddef>
#include <vector>

#include "pose_refinement.hpp"

namespace drape::alignment {

/// Whether two poses show the body as the same thing in the photo, which ways ever they turn it.
[[nodiscard]] bool in_one_place(const OutlinePose& a, const OutlinePose& b);

/// Best first by score, no more than `most`. Of poses within three degrees of each other the one with the
/// best closeness stands for all.
[[nodiscard]] std::vector<RefinedPose> distinct_poses(std::vector<RefinedPose> poses, std::size_t most);

[[nodiscard]] std::vector<OutlinePose> poses_of(const std::vector<RefinedPose>& refined);

}  // namespace drape::alignment
