// From nothing to a few refined poses.
#pragma once

#include <functional>
#include <vector>

#include "drape/base/progress.hpp"
#include "evidence.hpp"
#include "pose_refinement.hpp"

namespace drape::alignment {

/// The mesh with fewer and more faces.
struct MeshLevels {
  OutlineMesh coarse;  // for all rotations
  OutlineMesh middle;
  OutlineMesh full;
};

struct SearchStatistics {
  double coarse_seconds = 0;
  int candidates_listed = 0;
  int candidates_tried = 0;
};

struct SearchSettings {
  LensPrior lens;
  bool principal_point_known = false;
  /// Which poses may be tried; empty: all.
  std::function<bool(const OutlinePose&)> allowed;
  /// Tried instead of all rotations; empty: none.
  std::vector<OutlinePose> starts;
};

struct PoseSearchResult {
  std::vector<RefinedPose> poses;  // distinct, best first, refined on the full mesh at the last level
  SearchStatistics statistics;
};

/// Every evidence is searched alike: all views and rolls by polar pictures, the best by outlines from coarse
/// to fine. Where the best pose at the coarse level does not explain the outline well, the photo's stencil is
/// taken to be wrong in part, and other places and sizes of the object are tried as well.
[[nodiscard]] PoseSearchResult search_poses(const MeshLevels& meshes, const Evidence& evidence,
                                            const SearchSettings& settings, const Progress& progress);

}  // namespace drape::alignment
