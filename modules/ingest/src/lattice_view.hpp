// The sampling lattice as its rays see it.
#pragma once

#include "drape/geometry/range_scan.hpp"

namespace drape::ingest {

/// The scan's view where it is known. Else, with a grid, the direction of parallel rays that explains it
/// best: row and column are regressed on the position, and the ray is the direction along which neither
/// changes (unknown stays unknown if they are not linear in it, as for diverging rays); of the two senses
/// the one from which the surface bulges towards the scanner. Else unknown.
[[nodiscard]] ScanView view_or_lattice_axis(const RangeScan& scan);

/// Index of the point in a cell; RangeGrid::missing also outside the grid.
[[nodiscard]] inline std::int32_t cell_or_missing(const RangeGrid& grid, int row, int column) {
  if (row < 0 || column < 0 || row >= grid.rows || column >= grid.columns) return RangeGrid::missing;
  return grid.at(row, column);
}

/// A step between two points, split by the ray through the first.
struct RayStep {
  double along;   // positive: the second point is further from the scanner
  double across;  // not negative
};
[[nodiscard]] RayStep ray_step(const ScanView& view, const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// Standard deviation of the range noise, from the second differences of depth along rows (their median, so
/// that depth edges do not count); 0 without a grid or a view.
[[nodiscard]] double range_noise(const RangeScan& scan, const ScanView& view);

}  // namespace drape::ingest
