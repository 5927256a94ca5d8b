#include "near_search.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>

#include "distinct_poses.hpp"

namespace drape::alignment {
namespace {

constexpr double turn_rad = 5 * std::numbers::pi / 180;
constexpr std::array<double, 3> lens_factors = {1, 0.4, 2.5};
constexpr std::size_t kept_for_full = 3;

std::vector<OutlinePose> neighbours_of(const OutlinePose& pose, const LensPrior& lens) {
  const bool free_lens = !lens.orthographic && !lens.fixed_focal_px;
  std::vector<OutlinePose> all;
  for (const double factor : lens_factors) {
    if (factor != 1 && !free_lens) continue;
    OutlinePose other = pose;
    other.perspective = std::min(0.7, factor * pose.perspective);
    if (factor != 1) all.push_back(other);
    for (int axis = 0; axis < 3; ++axis)
      for (const double turn : {turn_rad, -turn_rad}) {
        OutlinePose turned = other;
        turned.rotation =
            Eigen::AngleAxisd(turn, Eigen::Vector3d::Unit(axis)).toRotationMatrix() * pose.rotation;
        all.push_back(turned);
      }
  }
  return all;
}

void keep_best(std::vector<RefinedPose>& poses) {
  std::stable_sort(poses.begin(), poses.end(), [](const RefinedPose& a, const RefinedPose& b) {
    return a.agreement.score() > b.agreement.score();
  });
  poses.resize(std::min(poses.size(), kept_for_full));
}

}  // namespace

std::vector<RefinedPose> search_near(const OutlinePose& about, const MeshLevels& meshes,
                                     const Evidence& evidence, const LensPrior& lens,
                                     const Progress& progress) {
  const int last = evidence.levels() - 1;
  const RefinementPlan middle{std::min(1, last), 8, 6, 2, 1.0, false};
  const RefinementPlan held{std::min(1, last), 7, 8, 3, 1.0, false, true};
  const RefinementPlan fine{last, 8, 5, 1.5, 1.0, false};
  // A pose turns a long way with the lens: the turn is found first.
  std::vector<RefinedPose> poses =
      refine_poses(meshes.middle, neighbours_of(about, lens), evidence, lens, held, progress);
  poses = refine_poses(meshes.middle, poses_of(poses), evidence, lens, middle, progress);
  keep_best(poses);
  poses = refine_poses(meshes.full, poses_of(poses), evidence, lens, fine, progress);
  keep_best(poses);
  return poses;
}

}  // namespace drape::alignment
