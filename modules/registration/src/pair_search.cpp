#include "pair_search.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "coarse_fit.hpp"
#include "consistent_motions.hpp"

namespace drape::registration {
namespace {

constexpr std::size_t most_matches = 2000;
constexpr std::size_t most_guesses = 150;
constexpr std::size_t most_fitted = 20;
constexpr std::size_t guess_samples = 500;
constexpr std::size_t fit_samples = 1200;

// Right pairs of real scans lie 0.14 to 0.26 voxels apart and contradict the lines of sight by up to 0.9 %
// (one by 2.1 %); wrong ones lie 0.31 to 0.48 voxels apart or contradict them by over 2.5 %.
constexpr double least_overlap = 0.1;
constexpr double most_rms_voxels = 0.28;
constexpr double most_contradiction = 0.015;
// Wrong pairs that nothing else gives away share a round body: 0.02. Most scans that are held have 0.03 and
// more.
constexpr double least_hold = 0.025;
constexpr double noise_left = 0.6;  // of the noise of single points, in smoothed ones

std::size_t stride_for(const CoarseScan& scan, std::size_t samples) {
  return std::max<std::size_t>(1, scan.size() / samples);
}

std::vector<Rigid3> guesses_of(const SearchedScan& source, const SearchedScan& target, const PairHint& hint) {
  const std::vector<FeatureMatch> matches = match_features(source.features, target.features, most_matches);
  std::vector<Rigid3> guesses;
  for (const MotionGuess& guess :
       hint.rotation
           ? motions_with_rotation(source.coarse, target.coarse, matches, *hint.rotation, most_guesses)
           : consistent_motions(source.coarse, target.coarse, matches, most_guesses))
    guesses.push_back(guess.target_from_source);
  if (!hint.rotation) guesses.push_back(Rigid3::Identity());
  return guesses;
}

bool alike(const Rigid3& a, const Rigid3& b, const CoarseScan& scan) {
  const Eigen::Vector3d& p = scan.points()[scan.size() / 2];
  return (a * p - b * p).norm() < 2 * scan.voxel() &&
         (a.linear().transpose() * b.linear()).trace() > 1 + 2 * std::cos(0.1);
}

}  // namespace

PairPose judge_pair(const SearchedScan& source, const SearchedScan& target,
                    const Rigid3& target_from_source) {
  const Rigid3 source_from_target = target_from_source.inverse();
  const CoarseFit there = measure_fit(source.coarse, target.coarse, target_from_source, 1);
  const CoarseFit back = measure_fit(target.coarse, source.coarse, source_from_target, 1);
  const double voxel = source.coarse.voxel();
  PairPose pose{
      target_from_source,
      std::max(there.overlap, back.overlap),
      std::max(there.rms_voxels, back.rms_voxels),
      std::max(target.sight.seen_through_share(source.coarse.points(), target_from_source, voxel),
               source.sight.seen_through_share(target.coarse.points(), source_from_target, voxel)),
      std::max(
          target.sight.in_void_share(source.coarse.points(), source.coarse.normals(), target_from_source),
          source.sight.in_void_share(target.coarse.points(), target.coarse.normals(), source_from_target)),
      std::max(there.hold, back.hold),
      {}};
  const double noise = std::max(source.coarse.noise(), target.coarse.noise()) / voxel;
  const double most_rms = std::hypot(most_rms_voxels, noise_left * noise);
  if (pose.overlap < least_overlap)
    pose.against = fmt::format("only {:.0f} % overlap", 100 * pose.overlap);
  else if (pose.rms_voxels > most_rms)
    pose.against = fmt::format("their surfaces differ ({:.2f} of {:.2f} voxels)", pose.rms_voxels, most_rms);
  else if (pose.contradiction() > most_contradiction)
    pose.against =
        fmt::format("{:.1f} % of one lies where the other looked through, {:.1f} % where it saw nothing",
                    100 * pose.seen_through, 100 * pose.in_void);
  else if (pose.hold < least_hold)
    pose.against = "what they share slides on itself, as planes and round bodies do";
  return pose;
}

std::vector<PairPose> search_pair(const SearchedScan& source, const SearchedScan& target,
                                  const PairHint& hint, std::size_t most) {
  struct Scored {
    double overlap;
    Rigid3 motion;
  };
  std::vector<Scored> scored;
  for (const Rigid3& guess : guesses_of(source, target, hint))
    scored.push_back(
        {measure_fit(source.coarse, target.coarse, guess, stride_for(source.coarse, guess_samples)).overlap,
         guess});
  std::stable_sort(scored.begin(), scored.end(),
                   [](const Scored& a, const Scored& b) { return a.overlap > b.overlap; });
  if (scored.size() > most_fitted) scored.resize(most_fitted);

  std::vector<PairPose> poses;
  for (const Scored& guess : scored) {
    const PairPose pose = judge_pair(
        source, target,
        fit_coarsely(source.coarse, target.coarse, guess.motion, stride_for(source.coarse, fit_samples)));
    if (std::none_of(poses.begin(), poses.end(), [&](const PairPose& p) {
          return alike(p.target_from_source, pose.target_from_source, source.coarse);
        }))
      poses.push_back(pose);
  }
  std::stable_sort(poses.begin(), poses.end(), [](const PairPose& a, const PairPose& b) {
    return std::tuple(!a.against.empty(), -a.score()) < std::tuple(!b.against.empty(), -b.score());
  });
  if (poses.size() > most) poses.resize(most);
  return poses;
}

}  // namespace drape::registration
