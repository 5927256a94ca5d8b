#include "pair_search.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "coarse_fit.hpp"
#include "consistent_motions.hpp"
#include "fine_fit.hpp"
#include "pair_votes.hpp"

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
constexpr double hinted_cosine = 0.9;  // of half the rotation that a guess may be off the hint

// Right pairs of real scans lie 0.14 to 0.26 voxels apart, wrong ones 0.31 to 0.48. What contradicts the
// lines of sight is up to 3.1 % of what they share firmly in right pairs of real scans, 1.1 % in those of
// simulated ones, and over 4 % in the wrong ones of both that nothing else gives away.
constexpr double least_overlap = 0.1;
constexpr double most_rms_voxels = 0.3;
// Where nothing contradicts the lines of sight, edges and fine detail may lie further apart.
constexpr double more_if_clean = 1.15;
constexpr double clean = 0.002;
constexpr double most_contradiction = 0.035;  // of the firm overlap
constexpr double most_contradiction_of_weak = 0.01;
// Noise holds even a body of rotation by up to 0.0034. Below 0.025 wrong pairs occur that hardly contradict
// anything.
constexpr double least_hold = 0.012;
constexpr double sound_hold = 0.025;
constexpr double firm_hold = 0.06;  // what nearly slides on itself is easily shared by chance: it counts less
constexpr double contradiction_weight = 10;
constexpr double sight_tolerance_voxels = 0.5;
constexpr double sight_tolerance_deviations = 2.5;
// Patches of a scan that lie in front of what the other saw, or in its void: up to 0.1 % of what agrees in
// right simulated pairs, over 1.5 % in the wrong ones that nothing else gives away.
constexpr double half_sure = 0.01;
constexpr double half_sure_of_tried = 0.1;  // before they are fitted
constexpr double smooth_tolerance_voxels = 0.3;
constexpr double smooth_tolerance_deviations = 0.8;
constexpr double least_agreeing = 0.02;
constexpr double noise_left = 0.9;  // of the noise of single points, in smoothed ones

double firm_overlap(double overlap, double hold) {
  return overlap * std::min(1.0, hold / firm_hold);
}

double evidence(double overlap, double hold, double contradiction) {
  return firm_overlap(overlap, hold) - contradiction_weight * contradiction;
}

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

double seen_through_share(const SearchedScan& source, const SearchedScan& target,
                          const Rigid3& target_from_source) {
  const double noise = std::max(source.coarse.noise(), target.coarse.noise());
  const double tolerance =
      std::max(sight_tolerance_voxels * source.coarse.voxel(), sight_tolerance_deviations * noise);
  return std::max(
      target.sight.seen_through_share(source.coarse.points(), target_from_source, tolerance),
      source.sight.seen_through_share(target.coarse.points(), target_from_source.inverse(), tolerance));
}

// Of each way, against what agrees.
struct SmoothContradiction {
  double in_front = 0;
  double in_void = 0;

  [[nodiscard]] double sum() const { return in_front + in_void / 2; }
};

SmoothContradiction contradiction_of_smooth(const SearchedScan& source, const SearchedScan& target,
                                            const Rigid3& target_from_source) {
  const double tolerance =
      std::max(smooth_tolerance_voxels * source.coarse.voxel(),
               smooth_tolerance_deviations * std::max(source.coarse.noise(), target.coarse.noise()));
  const SightShares there = target.smooth_sight.compare(source.coarse, target_from_source, tolerance);
  const SightShares back =
      source.smooth_sight.compare(target.coarse, target_from_source.inverse(), tolerance);
  const double agreeing = std::max(there.agreeing + back.agreeing, least_agreeing);
  return {(there.in_front + back.in_front) / agreeing, (there.in_void + back.in_void) / agreeing};
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

double PairPose::score() const {
  const double sure = evidence(overlap, hold, contradiction());
  // Poses of the same pair differ in this more than in all else.
  return sure > 0 ? sure / (1 + contradiction_of_smooth / half_sure) : sure;
}

PairPose judge_pair(const SearchedScan& source, const SearchedScan& target, const Rigid3& target_from_source,
                    double slack) {
  const Rigid3 source_from_target = target_from_source.inverse();
  const CoarseFit there = measure_fit(source.coarse, target.coarse, target_from_source, 1);
  const CoarseFit back = measure_fit(target.coarse, source.coarse, source_from_target, 1);
  const double voxel = source.coarse.voxel();
  const SmoothContradiction smooth = contradiction_of_smooth(source, target, target_from_source);
  PairPose pose{
      target_from_source,
      std::max(there.overlap, back.overlap),
      std::max(there.rms_voxels, back.rms_voxels),
      seen_through_share(source, target, target_from_source),
      std::max(
          target.sight.in_void_share(source.coarse.points(), source.coarse.normals(), target_from_source),
          source.sight.in_void_share(target.coarse.points(), target.coarse.normals(), source_from_target)),
      std::max(there.hold, back.hold),
      smooth.sum(),
      smooth.in_void,
      {}};
  const double noise = std::max(source.coarse.noise(), target.coarse.noise()) / voxel;
  // Single returns where the smoothed ones, which count in patches, show nothing.
  const bool unseen_contradiction = pose.contradiction_of_smooth == 0 && pose.in_void == 0;
  const bool is_clean = pose.contradiction_of_smooth < clean && pose.contradiction() < clean;
  const double most_rms =
      (is_clean ? more_if_clean : 1.0) * slack * std::hypot(most_rms_voxels, noise_left * noise);
  if (pose.overlap < least_overlap)
    pose.against = fmt::format("only {:.0f} % overlap", 100 * pose.overlap);
  else if (pose.rms_voxels > most_rms)
    pose.against = fmt::format("their surfaces differ ({:.2f} of {:.2f} voxels)", pose.rms_voxels, most_rms);
  else if (pose.hold < least_hold)
    pose.against = "what they share slides on itself, as planes and round bodies do";
  else if (pose.contradiction() > (pose.hold < sound_hold && !unseen_contradiction
                                       ? most_contradiction_of_weak
                                       : most_contradiction) *
                                      firm_overlap(pose.overlap, pose.hold))
    pose.against =
        fmt::format("{:.1f} % of one lies where the other looked through, {:.1f} % where it saw nothing",
                    100 * pose.seen_through, 100 * pose.in_void);
  return pose;
}

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
  sort_by_belief(poses);
  if (poses.size() > most) poses.resize(most);
  return poses;
}

}  // namespace drape::registration
