// Rigid motions that many matches agree on, however many others do not.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "coarse_scan.hpp"
#include "drape/geometry/rigid3.hpp"
#include "point_features.hpp"

namespace drape::registration {

struct MotionGuess {
  Rigid3 target_from_source = Rigid3::Identity();
  std::size_t agreeing = 0;  // matches
};

/// Motions of `source` onto `target`, most agreed on first, at most `most`, no two alike.
///
/// Two matches are compatible if the distance of their points and the angles between their normals and the
/// line through the points are the same in both scans. Wrong matches are compatible by chance, but not with
/// each other: of two compatible matches it counts how many others are compatible with both (second-order
/// spatial compatibility, Chen, Sun, Yang and Tao 2022). The matches that are so linked to a seed give a
/// motion (Horn 1987; normals count as further points); it is then fitted again to all that agree with it.
/// Nothing is drawn at random.
[[nodiscard]] std::vector<MotionGuess> consistent_motions(const CoarseScan& source, const CoarseScan& target,
                                                          std::span<const FeatureMatch> matches,
                                                          std::size_t most);

/// The same where the motion's rotation is known to within some degrees: matches vote for the translation.
[[nodiscard]] std::vector<MotionGuess> motions_with_rotation(const CoarseScan& source,
                                                             const CoarseScan& target,
                                                             std::span<const FeatureMatch> matches,
                                                             const Eigen::Matrix3d& rotation,
                                                             std::size_t most);

}  // namespace drape::registration
