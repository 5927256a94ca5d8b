// Whether the photo's colours prove the pose.
#pragma once

#include <vector>

#include "pose_refinement.hpp"
#include "pose_verdict.hpp"

namespace drape::alignment {

/// `poses` are distinct, best first, of the last level of the colours' evidence.
[[nodiscard]] PoseJudgement judge_color_poses(const std::vector<RefinedPose>& poses, const LensPrior& lens);

}  // namespace drape::alignment
