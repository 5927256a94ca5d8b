#include "color_verdict.hpp"

#include <fmt/core.h>

#include <numbers>

namespace drape::alignment {
namespace {

constexpr double degrees = 180 / std::numbers::pi;
// Chosen on simulated photos with clutter, of which the wrong poses have less.
constexpr double good_edges = 0.85;
constexpr double least_edges = 0.45;
constexpr double good_parting = 0.35;
constexpr double least_parting = 0.1;
constexpr double good_inliers = 0.6;
constexpr double least_margin = 0.04;  // of the score, in shares of it

}  // namespace

PoseJudgement judge_color_poses(const std::vector<RefinedPose>& poses, const LensPrior& lens) {
  PoseJudgement judgement;
  if (poses.empty()) {
    judgement.reasons = {"no pose of the mesh parts the photo's colours"};
    return judgement;
  }
  const RefinedPose& best = poses.front();
  const Agreement& fit = best.agreement;
  judgement.sigma = pose_sigma(best, lens);
  const auto percent = [](double share) { return 100 * share; };
  if (fit.rim_inliers < least_edges || fit.overlap < least_parting) {
    judgement.reasons.push_back(fmt::format(
        "only {:.0f} % of the outline lies on edges of the photo, and it parts the colours by {:.0f} "
        "%: is the object in it?",
        percent(fit.rim_inliers), percent(fit.overlap)));
    return judgement;
  }
  judgement.verdict = Verdict::accept;
  const auto doubt = [&](std::string reason) {
    judgement.verdict = Verdict::review;
    judgement.reasons.push_back(std::move(reason));
  };
  if (fit.rim_inliers < good_edges)
    doubt(fmt::format("{:.0f} % of the outline lies on edges of the photo", percent(fit.rim_inliers)));
  if (fit.overlap < good_parting || fit.image_inliers < good_inliers)
    doubt(
        fmt::format("the outline parts the photo's colours by {:.0f} %, and {:.0f} % of it lies where they "
                    "change",
                    percent(fit.overlap), percent(fit.image_inliers)));
  while (judgement.rivals + 1 < poses.size() &&
         poses[judgement.rivals + 1].agreement.score() > (1 - least_margin) * fit.score())
    ++judgement.rivals;
  if (judgement.rivals > 0)
    doubt(fmt::format("a pose {:.0f} degrees away fits nearly as well",
                      angle_between(best.pose.rotation, poses[1].pose.rotation) * degrees));
  if (judgement.reasons.empty())
    judgement.reasons.push_back(
        fmt::format("{:.0f} % of the outline lies on edges of the photo", percent(fit.rim_inliers)));
  return judgement;
}

}  // namespace drape::alignment
