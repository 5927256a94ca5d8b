// A first pose for each scan.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drape/base/progress.hpp"
#include "drape/geometry/range_scan.hpp"
#include "drape/geometry/rigid3.hpp"
#include "drape/registration/register_scans.hpp"
#include "scan_surface.hpp"

namespace drape::registration {

/// "bun045.ply", or "room.e57 (scan 3)" where it is not the first of its file.
[[nodiscard]] std::string label(const RangeScan& scan);

struct GivenPlacement {
  std::vector<PlacedScan> scans;
  std::optional<std::size_t> world_scan;  // the scan whose frame is the world, where no pose was given at all
};

/// The poses that are given, else stated by the scans themselves; without any, the first scan with points is
/// the world. Scans without pose or points are not placed.
[[nodiscard]] GivenPlacement place_given(std::span<const RangeScan> scans,
                                         std::span<const std::optional<Rigid3>> given_world_from_scan);

/// Tries each scan that is not placed against all that are: pairwise ICP from the poses of the nearest
/// placed scans in the list and from identity; a result is taken if the overlap, the distance and the line
/// of sight agree with it. Scans placed so help to place others.
[[nodiscard]] std::vector<PlacedScan> place_by_icp(std::vector<PlacedScan> placed,
                                                   std::span<const RangeScan> scans,
                                                   std::span<const ScanSurface> surfaces, double reach,
                                                   const RegisterOptions& options, const Progress& progress);

}  // namespace drape::registration
