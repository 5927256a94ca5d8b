// Small groups of points that lie apart from the rest.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "drape/geometry/range_scan.hpp"

namespace drape::ingest {

/// Flags of the points in groups of fewer than `least_points`; the largest group (of equals the first) is
/// never flagged. Points closer than `gap_spacings` belong to one group: space is cut into cubes of that
/// edge, and cubes that touch are one group. With a grid and a view, space is (row, column, depth in local
/// spacings), so that neither oblique surfaces nor far ones fall apart. `order` names every point once, best
/// so that those near each other are side by side (morton_order).
[[nodiscard]] std::vector<std::uint8_t> small_islands(const RangeScan& scan, const ScanView& view,
                                                      double spacing, double gap_spacings,
                                                      std::size_t least_points,
                                                      std::span<const std::uint32_t> order);

}  // namespace drape::ingest
