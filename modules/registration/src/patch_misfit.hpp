// Whether two noisy scans differ by more than their noise, patch by patch.
#pragma once

#include "coarse_scan.hpp"
#include "drape/geometry/rigid3.hpp"
#include "scan_surface.hpp"

namespace drape::registration {

/// Mean signed distances of patches of one scan's points to the other's surface, both ways, against what the
/// noise of single points leaves of such a mean: the upper quartile. 1.2 where only noise keeps the scans
/// apart, 2 to 4 in right pairs, where edges and small detail add to it; surfaces that are only alike have
/// patches that lie before or behind the other on the whole. 0 where the scans have next to no noise: then
/// spacing and curvature, not noise, are what keeps right pairs apart, and the measure says nothing.
[[nodiscard]] double patch_misfit(const ScanSurface& source, const CoarseScan& coarse_source,
                                  const ScanSurface& target, const CoarseScan& coarse_target,
                                  const Rigid3& target_from_source);

}  // namespace drape::registration
