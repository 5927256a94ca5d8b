#include "block_pose.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace drape::alignment {

Similarity moved(const Similarity& similarity, const SimilarityVector& step, const Eigen::Vector3d& center) {
  const Eigen::Vector3d turn = step.head<3>();
  const double angle = turn.norm();
  Similarity result = similarity;
  if (angle > 0) result.rotation = Eigen::AngleAxisd(angle, turn / angle) * similarity.rotation;
  result.scale = similarity.scale * std::exp(step[3]);
  const Eigen::Vector3d place =
      similarity.scale * similarity.rotation * center + similarity.translation + step.tail<3>();
  result.translation = place - result.scale * result.rotation * center;
  return result;
}

Rigid3 camera_from_world(const Rigid3& camera_from_block, const Similarity& block_from_world) {
  Rigid3 pose = Rigid3::Identity();
  pose.linear() = camera_from_block.linear() * block_from_world.rotation;
  pose.translation() = (camera_from_block * block_from_world.translation) / block_from_world.scale;
  return pose;
}

// x_camera * s = R_block (s R x + t) + t_block for each camera, so that s R_c x + s t_c with the pose (R_c,
// t_c) found in the photo gives t = R_block^T (s t_c - t_block): linear in s.
std::optional<PairOpinion> pair_opinion(const Rigid3& first_from_block, const Rigid3& first_from_world,
                                        const Rigid3& second_from_block, const Rigid3& second_from_world) {
  const Eigen::Quaterniond a(first_from_block.linear().transpose() * first_from_world.linear());
  const Eigen::Quaterniond b(second_from_block.linear().transpose() * second_from_world.linear());
  PairOpinion opinion;
  opinion.disagreement_rad = a.angularDistance(b);
  Similarity& middle = opinion.block_from_world;
  middle.rotation = a.slerp(0.5, b).normalized().toRotationMatrix();
  const auto in_block = [](const Rigid3& from_block, const Eigen::Vector3d& t) -> Eigen::Vector3d {
    return from_block.linear().transpose() * t;
  };
  const Eigen::Vector3d along = in_block(first_from_block, first_from_world.translation()) -
                                in_block(second_from_block, second_from_world.translation());
  const Eigen::Vector3d apart = in_block(first_from_block, first_from_block.translation()) -
                                in_block(second_from_block, second_from_block.translation());
  middle.scale = along.dot(apart) / along.squaredNorm();
  if (!(middle.scale > 0) || !std::isfinite(middle.scale)) return std::nullopt;
  const auto translation = [&](const Rigid3& from_block, const Rigid3& from_world) {
    return in_block(from_block, middle.scale * from_world.translation() - from_block.translation());
  };
  middle.translation = 0.5 * (translation(first_from_block, first_from_world) +
                              translation(second_from_block, second_from_world));
  return opinion;
}

}  // namespace drape::alignment
