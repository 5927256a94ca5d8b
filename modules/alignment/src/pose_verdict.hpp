// Whether the outline proves the pose.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drape/alignment/align.hpp"
#include "evidence.hpp"
#include "pose_refinement.hpp"

namespace drape::alignment {

struct PoseJudgement {
  Verdict verdict = Verdict::reject;
  std::vector<std::string> reasons;
  std::optional<PoseSigma> sigma;
  std::optional<Eigen::Vector3d> free_axis;  // of rotation, in the mesh's axes
  std::size_t rivals = 0;                    // of the poses after the first: how many fit nearly as well
};

/// `poses` are distinct, best first, of the evidence's last level.
/// `figures` are of the first: its fit and noise are given, its margin and deviation are found.
[[nodiscard]] PoseJudgement judge_poses(const std::vector<RefinedPose>& poses, const LensPrior& lens,
                                        OutlineFigures& figures);

/// What speaks against a pose that `inliers` of the outline (the lesser share of the model's and the photo's)
/// fit: nothing where that is `enough`, or all but one part fits, and it is not too rough. `forgiven` says
/// what that part is, if it is needed.
struct OutlineDoubts {
  std::vector<std::string> reasons;
  std::string forgiven;
};
[[nodiscard]] OutlineDoubts outline_doubts(double inliers, const OutlineFigures& figures, double enough);

/// Of the score over the best distinct pose: the rougher the outline, the more.
[[nodiscard]] double needed_margin(const OutlineFigures& figures);

/// As the residuals of the pose's refinement tell it; nothing where there were none.
[[nodiscard]] std::optional<PoseSigma> pose_sigma(const RefinedPose& pose, const LensPrior& lens);

}  // namespace drape::alignment
