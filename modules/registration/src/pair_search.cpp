#include "pair_search.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "coarse_fit.hpp"
#include "consistent_motions.hpp"
#include "fine_fit.hpp"
#include "pair_votes.hpp"
#include "sliding.hpp"

namespace drape::registration {
namespace {

constexpr std::size_t most_matches = 2000;
constexpr std::size_t feature_guesses = 150;
constexpr std::size_t vote_guesses = 500;
constexpr std::size_t guess_samples = 500;
// Guesses are tried by a few steps on few points, the best of those are fitted.
constexpr std::size_t most_tried = 60;
constexpr std::size_t most_tried_thoroughly = 800;
constexpr std::size_t try_samples = 300;
constexpr int try_steps = 8;
constexpr std::size_t most_fitted = 12;
constexpr std::size_t most_looked_at = 200;  // of those tried thoroughly, by what the other scanner saw
constexpr std::size_t most_fitted_thoroughly = 30;
constexpr std::size_t fit_samples = 1200;
constexpr int fit_steps = 24;
constexpr std::size_t most_refined = 4;
// Held less, a pose is fitted by all points; sharing less, it is given up.
constexpr double firm_hold = 0.06;
constexpr double least_overlap = 0.1;
constexpr double hinted_cosine = 0.9;  // of half the rotation that a guess may be off the hint

// Before they are fitted.
constexpr double half_sure_of_tried = 0.1;
std::size_t stride_for(const CoarseScan& scan, std::size_t samples) {
  return std::max<std::size_t>(1, scan.size() / samples);
}

std::vector<Rigid3> guesses_of(const SearchedScan& source, const SearchedScan& target, const PairHint& hint,
                               Effort effort) {
  const std::vector<FeatureMatch> matches = match_features(source.features, target.features, most_matches);
  std::vector<Rigid3> guesses;
  for (const MotionGuess& guess :
       hint.rotation
           ? motions_with_rotation(source.coarse, target.coarse, matches, *hint.rotation, feature_guesses)
           : consistent_motions(source.coarse, target.coarse, matches, feature_guesses))
    guesses.push_back(guess.target_from_source);
  if (!hint.rotation) guesses.push_back(Rigid3::Identity());
  if (effort == Effort::quick) return guesses;
  for (const MotionGuess& guess : voted_motions(source.coarse, target.coarse, vote_guesses))
    if (!hint.rotation ||
        Eigen::Quaterniond(hint.rotation->transpose() * guess.target_from_source.linear()).w() >
            hinted_cosine)
      guesses.push_back(guess.target_from_source);
  return guesses;
}

struct Tried {
  Rigid3 motion;
  double score;
};

// Keeps the best `most`, best first; equal ones stay in order.
void keep_best(std::vector<Tried>& tried, std::size_t most) {
  std::stable_sort(tried.begin(), tried.end(),
                   [](const Tried& a, const Tried& b) { return a.score > b.score; });
  if (tried.size() > most) tried.resize(most);
}

// The guesses that lie well after a few steps, however well they lay before: the right one among them may
// still have been some degrees off.
std::vector<Tried> promising(const SearchedScan& source, const SearchedScan& target, const PairHint& hint,
                             Effort effort) {
  const std::size_t stride = stride_for(source.coarse, guess_samples);
  std::vector<Tried> tried;
  for (const Rigid3& guess : guesses_of(source, target, hint, effort))
    tried.push_back({guess, measure_fit(source.coarse, target.coarse, guess, stride).overlap});
  keep_best(tried, effort == Effort::quick ? most_tried : most_tried_thoroughly);
  for (Tried& one : tried) {
    one.motion = fit_coarsely(source.coarse, target.coarse, one.motion,
                              stride_for(source.coarse, try_samples), try_steps);
    const CoarseFit fit = measure_fit(source.coarse, target.coarse, one.motion, stride);
    one.score = evidence(fit.overlap, fit.hold, seen_through_share(source, target, one.motion));
  }
  if (effort == Effort::quick) {
    keep_best(tried, most_fitted);
    return tried;
  }
  // Where little is shared, wrong ways to lie on much of the other scan are many: most are seen not to be.
  keep_best(tried, most_looked_at);
  for (Tried& one : tried)
    if (one.score > 0)
      one.score /= 1 + contradiction_of_smooth(source, target, one.motion).sum() / half_sure_of_tried;
  keep_best(tried, most_fitted_thoroughly);
  return tried;
}

void sort_by_belief(std::vector<PairPose>& poses) {
  std::stable_sort(poses.begin(), poses.end(), [](const PairPose& a, const PairPose& b) {
    return std::tuple(!a.against.empty(), -a.score()) < std::tuple(!b.against.empty(), -b.score());
  });
}

bool alike(const Rigid3& a, const Rigid3& b, const CoarseScan& scan) {
  const Eigen::Vector3d& p = scan.points()[scan.size() / 2];
  return (a * p - b * p).norm() < 2 * scan.voxel() &&
         (a.linear().transpose() * b.linear()).trace() > 1 + 2 * std::cos(0.1);
}

}  // namespace

std::vector<PairPose> search_pair(const SearchedScan& source, const SearchedScan& target,
                                  const PairHint& hint, Effort effort, std::size_t most) {
  std::vector<PairPose> poses;
  for (const Tried& tried : promising(source, target, hint, effort)) {
    const PairPose pose = judge_pair(source, target,
                                     fit_coarsely(source.coarse, target.coarse, tried.motion,
                                                  stride_for(source.coarse, fit_samples), fit_steps));
    if (std::none_of(poses.begin(), poses.end(), [&](const PairPose& p) {
          return alike(p.target_from_source, pose.target_from_source, source.coarse);
        }))
      poses.push_back(pose);
  }
  sort_by_belief(poses);
  if (poses.size() > most_refined) poses.resize(most_refined);
  // Along what hardly holds them coarse scans drift.
  for (PairPose& pose : poses)
    if (pose.hold < firm_hold && pose.overlap > least_overlap)
      pose = judge_pair(
          source, target,
          fit_finely(*source.surface, *target.surface, pose.target_from_source, source.coarse.voxel()));
  for (PairPose& pose : poses)
    if (pose.slides())
      if (const auto slide = slide_to_middle(source, target, pose.target_from_source))
        pose = judge_pair(source, target, slide->target_from_source, 1, true);
  sort_by_belief(poses);
  if (poses.size() > most) poses.resize(most);
  return poses;
}

}  // namespace drape::registration
