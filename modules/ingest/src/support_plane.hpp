// The table or floor that an object stands on.
#pragma once

#include <cstdint>
#include <vector>

#include "drape/geometry/range_scan.hpp"

namespace drape::ingest {

/// Flags of the points within `tolerance` of the plane that the object stands on, and behind it; nothing is
/// flagged where there is none. The plane is the one with the most support (MSAC, Torr and Zisserman 2000, by
/// PCL, then least squares). It counts as a support if it holds a sixth of the points at least, the scanner
/// sees its front, and of the other points 95 % lie in front of it: a flat side of the object itself has the
/// object behind it. None without a view, which tells front from back. The points must be finite; `tolerance`
/// is in the scan's unit.
[[nodiscard]] std::vector<std::uint8_t> support_plane(const RangeScan& scan, const ScanView& view,
                                                      double tolerance);

}  // namespace drape::ingest
