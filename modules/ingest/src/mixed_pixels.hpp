// Points that hang in the air between the two sides of a depth edge.
#pragma once

#include <cstdint>
#include <vector>

#include "drape/geometry/range_scan.hpp"

namespace drape::ingest {

/// Flags of the points which the lattice shows to lie on no surface that the scanner could see. A step
/// between neighbours is steep if it is more than `angle_deg` off the plane across the ray and well above
/// the range noise. A point is flagged if, along a row, a column or a diagonal, it lies steeply behind one
/// neighbour and steeply in front of the opposite one; or if all its steps but at most one are steep, some
/// forwards and some backwards. None without a grid or a view.
[[nodiscard]] std::vector<std::uint8_t> mixed_pixels(const RangeScan& scan, const ScanView& view,
                                                     double angle_deg);

}  // namespace drape::ingest
