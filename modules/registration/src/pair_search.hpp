// How two scans lie to each other, without a guess.
#pragma once

#include <optional>
#include <vector>

#include "pair_pose.hpp"

namespace drape::registration {

/// How hard to look.
enum class Effort {
  quick,     // at what local features agree on
  thorough,  // also at what pairs of points all over the scans vote for: noisy scans, and those that share
             // little, need it
};

/// What is known of a pair before it is searched.
struct PairHint {
  std::optional<Eigen::Matrix3d> rotation;  // of target_from_source, to within some degrees
};

/// The ways that two scans may lie to each other, best first, at most `most`; what nothing speaks against
/// comes before the rest. Motions that feature matches agree on, that of scans taken from the same place, and
/// those that pairs of points vote for, are tried by a few steps of a fit; the best of these are fitted in
/// full, and of them the overlap, the distance and the lines of sight are judged.
[[nodiscard]] std::vector<PairPose> search_pair(const SearchedScan& source, const SearchedScan& target,
                                                const PairHint& hint, Effort effort, std::size_t most);

}  // namespace drape::registration
