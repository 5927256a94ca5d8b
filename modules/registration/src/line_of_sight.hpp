// Whether a scan's points lie where another scan looked through.
#pragma once

#include "drape/geometry/rigid3.hpp"
#include "scan_surface.hpp"

namespace drape::registration {

/// Of the samples of `surface` that `viewer` has returns around, the share that lies more than `tolerance`
/// in front of what it saw there: the viewer would have seen them instead. 0 where nothing can be said: the
/// viewer's view is unknown, or no sample lies in it. In right pairs of scans it is next to nothing, in most
/// wrong ones it is not.
[[nodiscard]] double seen_through_share(const ScanSurface& surface, const ScanSurface& viewer,
                                        const Rigid3& viewer_from_surface, double tolerance);

}  // namespace drape::registration
