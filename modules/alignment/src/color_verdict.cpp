#include "color_verdict.hpp"

#include <fmt/core.h>

#include <numbers>

namespace drape::alignment {
namespace {

constexpr double degrees = 180 / std::numbers::pi;
// Between the right poses of 20 simulated photos with clutter (edges 0.92 and more, parting 0.65, inliers
// 0.94, score 0.56, margin 0.12) and the best poses of 60 meshes in photos without them (edges up to 0.96,
// parting 0.74, inliers under 0.7 where the edges are good, score up to 0.23); edges of real photos are
// weaker.
constexpr double good_edges = 0.9;
constexpr double least_edges = 0.45;
constexpr double good_parting = 0.45;
constexpr double least_parting = 0.1;
constexpr double good_inliers = 0.8;
constexpr double good_score = 0.5;    // of all of them together; wrong poses in whole photos: up to 0.44
constexpr double least_margin = 0.2;  // of the score, in shares of it

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
  if (fit.overlap < good_parting || fit.image_inliers < good_inliers || fit.score() < good_score)
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
