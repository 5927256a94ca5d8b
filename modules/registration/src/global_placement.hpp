// Poses for scans that have none.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drape/base/progress.hpp"
#include "drape/geometry/range_scan.hpp"
#include "drape/registration/register_scans.hpp"
#include "pair_search.hpp"
#include "scan_surface.hpp"

namespace drape::registration {

struct GlobalPlacement {
  std::vector<PlacedScan> scans;
  std::vector<SearchedPair> pairs;
  std::vector<std::optional<SearchedScan>> searched;  // of each scan that spans a surface
  double voxel = 0;                                   // the poses are right to a fraction of it
  std::optional<std::size_t> world_scan;  // whose frame is the world, where no scan was placed before
};

/// Searches every pair of scans in which one is not placed (of those that RegisterOptions' hints leave), and
/// joins what agrees: to the placed scans where there are any, else the largest group about its first scan's
/// frame. The rest stays unplaced, with the reason.
[[nodiscard]] GlobalPlacement place_globally(std::vector<PlacedScan> placed, std::span<const RangeScan> scans,
                                             std::span<const ScanSurface> surfaces,
                                             const RegisterOptions& options, const Progress& progress);

/// What speaks against the place of one scan among the others; empty if at least one other bears it out, and
/// none contradicts it.
[[nodiscard]] std::string objection(std::size_t which, const std::vector<PlacedScan>& placed,
                                    const std::vector<std::optional<SearchedScan>>& searched);

}  // namespace drape::registration
