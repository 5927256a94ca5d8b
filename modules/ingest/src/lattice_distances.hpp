// How far neighbours lie from each other, seen from the sampling lattice.
#pragma once

#include <cstddef>
#include <vector>

#include "drape/geometry/ordered_points.hpp"
#include "drape/geometry/range_scan.hpp"
#include "drape/ingest/point_spacing.hpp"

namespace drape::ingest {

/// Per point the mean distance to its `neighbors` nearest others, as measure_neighborhoods has it, divided by
/// the local over the median spacing. The nearest of those around a point on the grid bound it from above:
/// where the bound is hardly more than the mean of all, it stands for the distance; only the other points,
/// beside depth edges and gaps, are looked up in space. The scan must have a grid; `points` are its points.
[[nodiscard]] std::vector<double> lattice_distances(const RangeScan& scan, const OrderedPoints& points,
                                                    const LocalSpacing& spacing, std::size_t neighbors);

}  // namespace drape::ingest
