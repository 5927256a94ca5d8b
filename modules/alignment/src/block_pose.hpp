// One similarity and the poses that it gives the mesh in every photo of a block.
#pragma once

#include <span>
#include <vector>

#include "drape/alignment/align_block.hpp"

namespace drape::alignment {

/// Order of the parameters: rotation vector (in the block's axes, from the left), logarithm of the scale,
/// translation.
inline constexpr int similarity_parameters = 7;
using SimilarityVector = Eigen::Matrix<double, similarity_parameters, 1>;

/// About `center` (in the world), so that the rotation does not move what is seen there.
[[nodiscard]] Similarity moved(const Similarity& similarity, const SimilarityVector& step,
                               const Eigen::Vector3d& center);

/// The mesh's pose before one camera, in the mesh's unit: what is seen does not depend on the unit.
[[nodiscard]] Rigid3 camera_from_world(const Rigid3& camera_from_block, const Similarity& block_from_world);

/// Of two cameras of the block, each with a pose of the mesh: the rotation between both opinions (radians),
/// and the similarity that is between them. Nothing if they contradict each other about the scale.
struct PairOpinion {
  double disagreement_rad = 0;
  Similarity block_from_world;
};
[[nodiscard]] std::optional<PairOpinion> pair_opinion(const Rigid3& first_from_block,
                                                      const Rigid3& first_from_world,
                                                      const Rigid3& second_from_block,
                                                      const Rigid3& second_from_world);

}  // namespace drape::alignment
