// How far scans slide on each other until what they saw forbids it.
#pragma once

#include <optional>

#include "drape/geometry/rigid3.hpp"
#include "searched_scan.hpp"

namespace drape::registration {

/// Where a scan lies between what contradicts it on either side.
struct Slide {
  Rigid3 target_from_source;  // in the middle
  double play_voxels;         // how far it may be moved from there, either way
  double contradiction;       // there: shares of the points, both ways together
};

/// Scans that share a surface which slides on itself, as an extruded one does, may yet be held by where it
/// ends: moved along, one comes to lie in front of what the other saw, or beside all that it saw. Moves
/// `source` along the motions that the shared surface hardly holds (Gelfand et al. 2003), into the middle
/// between such contradictions. Nothing where they leave too much play, as on planes and bodies of rotation,
/// or where the scans contradict each other even there.
[[nodiscard]] std::optional<Slide> slide_to_middle(const SearchedScan& source, const SearchedScan& target,
                                                   const Rigid3& target_from_source);

}  // namespace drape::registration
