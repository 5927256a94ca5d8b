// Many photos whose cameras are known among themselves, brought to the mesh at once.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "drape/alignment/align.hpp"
#include "drape/geometry/rigid3.hpp"

namespace drape::alignment {

/// x_in_block = scale * rotation * x_in_world + translation.
struct Similarity {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
};

struct BlockPhoto {
  PhotoEvidence evidence;  // with its lens
  Rigid3 camera_from_block = Rigid3::Identity();
};

struct BlockAlignment {
  std::vector<Alignment> photos;  // in the order given; all of one verdict
  std::optional<Similarity> block_from_world;
  Verdict verdict = Verdict::reject;
  std::vector<std::string> reasons;
};

/// Finds the similarity that puts the mesh before all cameras of a block: of the poses that each photo's
/// stencil allows by itself (align_photo's candidates) those of two photos that agree about the mesh's
/// rotation make a hypothesis; the one that fits the stencils of all photos best is refined on all of them
/// together, by Gauss-Newton on the outlines. What a single photo leaves open (mirror twins, views along an
/// axis) the others decide. Only perspective photos; each has its K and distortion kept.
///
/// Error{config} for fewer than two photos, a photo without its lens, or cameras that all stand in one place:
/// they tell nothing of the scale. Else as align_photo.
[[nodiscard]] BlockAlignment align_block(const TriangleMesh& mesh, const std::vector<BlockPhoto>& photos,
                                         const AlignOptions& options, std::uint64_t seed,
                                         const Progress& progress);

}  // namespace drape::alignment
