// Small groups of points that lie apart from the rest.
#pragma once

#include <cstdint>
#include <vector>

#include "drape/geometry/range_scan.hpp"

namespace drape::ingest {

/// Flags of the points in groups of fewer than `least_points`; the largest group (of equals the first) is
/// never flagged. Points closer than `gap_spacings` belong to one group: space is cut into cubes of that
/// edge, and cubes that touch are one group. With a grid and a view, space is (row, column, depth in local
/// spacings), so that neither oblique surfaces nor far ones fall apart.
[[nodiscard]] std::vector<std::uint8_t> small_islands(const RangeScan& scan, const ScanView& view,
                                                      double spacing, double gap_spacings,
                                                      std::size_t least_points);

}  // namespace drape::ingest
