#include "distinct_poses.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace drape::alignment {
namespace {

constexpr double same_pose_rad = 3 * std::numbers::pi / 180;
constexpr double same_place = 0.5;  // in radii of the mesh
constexpr double same_size = 0.5;   // of the logarithm

}  // namespace

bool in_one_place(const OutlinePose& a, const OutlinePose& b) {
  return (a.shift - b.shift).norm() < same_place * std::min(a.scale, b.scale) &&
         std::abs(std::log(a.scale / b.scale)) < same_size;
}

std::vector<RefinedPose> distinct_poses(std::vector<RefinedPose> poses, std::size_t most) {
  std::stable_sort(poses.begin(), poses.end(), [](const RefinedPose& a, const RefinedPose& b) {
    return a.agreement.score() > b.agreement.score();
  });
  std::vector<RefinedPose> kept;
  for (RefinedPose& pose : poses) {
    if (kept.size() == most) break;
    const auto seen = std::find_if(kept.begin(), kept.end(), [&](const RefinedPose& better) {
      return angle_between(better.pose.rotation, pose.pose.rotation) < same_pose_rad &&
             in_one_place(better.pose, pose.pose);
    });
    if (seen != kept.end() && pose.agreement.closeness() > seen->agreement.closeness()) *seen = pose;
    if (seen == kept.end()) kept.push_back(std::move(pose));
  }
  return kept;
}

std::vector<OutlinePose> poses_of(const std::vector<RefinedPose>& refined) {
  std::vector<OutlinePose> poses;
  for (const RefinedPose& r : refined) poses.push_back(r.pose);
  return poses;
}

}  // namespace drape::alignment
