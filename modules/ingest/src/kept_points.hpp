// A scan without some of its points.
#pragma once

#include <cstdint>
#include <vector>

#include "drape/geometry/range_scan.hpp"

namespace drape::ingest {

/// The scan without the points whose flag is not 0: attributes follow, the order stays, and the grid's cells
/// are renumbered or become missing.
[[nodiscard]] RangeScan without_points(RangeScan scan, const std::vector<std::uint8_t>& drop);

}  // namespace drape::ingest
