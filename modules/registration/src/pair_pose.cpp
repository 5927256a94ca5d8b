#include "pair_pose.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "coarse_fit.hpp"

namespace drape::registration {
namespace {

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
constexpr double least_agreeing = 0.02;
constexpr double noise_left = 0.9;  // of the noise of single points, in smoothed ones

double firm_overlap(double overlap, double hold) {
  return overlap * std::min(1.0, hold / firm_hold);
}

}  // namespace

double evidence(double overlap, double hold, double contradiction) {
  return firm_overlap(overlap, hold) - contradiction_weight * contradiction;
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

SmoothContradiction contradiction_of_smooth(const SearchedScan& source, const SearchedScan& target,
                                            const Rigid3& target_from_source) {
  const double tolerance = smooth_tolerance(source.coarse, target.coarse);
  const SightShares there = target.smooth_sight.compare(source.coarse, target_from_source, tolerance);
  const SightShares back =
      source.smooth_sight.compare(target.coarse, target_from_source.inverse(), tolerance);
  const double agreeing = std::max(there.agreeing + back.agreeing, least_agreeing);
  return {(there.in_front + back.in_front) / agreeing, (there.in_void + back.in_void) / agreeing};
}

bool PairPose::slides() const {
  return overlap >= least_overlap && hold < least_hold;
}

double PairPose::firmness() const {
  return held_by_sight ? std::max(hold, sound_hold) : hold;
}

double PairPose::score() const {
  const double sure = evidence(overlap, firmness(), contradiction());
  // Poses of the same pair differ in this more than in all else.
  return sure > 0 ? sure / (1 + contradiction_of_smooth / half_sure) : sure;
}

PairPose judge_pair(const SearchedScan& source, const SearchedScan& target, const Rigid3& target_from_source,
                    double slack, bool held_by_sight) {
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
      held_by_sight,
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
  else if (pose.firmness() < least_hold)
    pose.against = "what they share slides on itself, as planes and round bodies do";
  else if (pose.contradiction() > (pose.firmness() < sound_hold && !unseen_contradiction
                                       ? most_contradiction_of_weak
                                       : most_contradiction) *
                                      firm_overlap(pose.overlap, pose.firmness()))
    pose.against =
        fmt::format("{:.1f} % of one lies where the other looked through, {:.1f} % where it saw nothing",
                    100 * pose.seen_through, 100 * pose.in_void);
  return pose;
}

}  // namespace drape::registration
