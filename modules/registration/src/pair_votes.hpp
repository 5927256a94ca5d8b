// Rigid motions that pairs of oriented points vote for: found without any local feature.
#pragma once

#include <cstddef>
#include <vector>

#include "coarse_scan.hpp"
#include "consistent_motions.hpp"

namespace drape::registration {

/// Motions of `source` onto `target`, most voted for first, at most `most`, no two alike.
///
/// Point pair features (Drost, Ulrich, Navab and Ilic 2010): two oriented points are told by their distance
/// and the three angles between their normals and the line through them. For a reference point of the source,
/// every other point votes for all places of the target (a point, and a turn about its normal) from where a
/// pair of the same feature starts. Pairs reach across all that the scans share, so that noise which drowns
/// the surroundings of every single point does not matter much; features that are common on the target, as
/// those of planes, count less. It takes some ten times as long as consistent_motions.
[[nodiscard]] std::vector<MotionGuess> voted_motions(const CoarseScan& source, const CoarseScan& target,
                                                     std::size_t most);

}  // namespace drape::registration
