// Normals from the neighbours on the sampling lattice.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "drape/geometry/range_scan.hpp"
#include "drape/ingest/point_spacing.hpp"

namespace drape::ingest {

/// Per point the unit normal (sign arbitrary) of the plane through the neighbours up to `radius_cells` away
/// on the grid, those across a depth edge left out; zero where fewer than 4 remain or they lie in one row or
/// column. The scan must have a grid.
[[nodiscard]] std::vector<Eigen::Vector3f> lattice_normals(const RangeScan& scan, const LocalSpacing& spacing,
                                                           double radius_cells);

}  // namespace drape::ingest
