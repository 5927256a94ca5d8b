#include "drape/ingest/point_spacing.hpp"

#include <algorithm>
#include <cmath>

#include "drape/base/parallel.hpp"
#include "lattice_view.hpp"
#include "neighborhoods.hpp"

namespace drape::ingest {
namespace {

double median(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Median distance across the rays of points that lie `rows` and `columns` cells apart.
double lattice_step(const RangeScan& scan, const ScanView& view, int rows, int columns) {
  const auto& points = scan.cloud.positions;
  const RangeGrid& grid = *scan.grid;
  std::vector<double> steps;
  for (int row = 0; row + rows < grid.rows; ++row)
    for (int column = 0; column + columns < grid.columns; ++column) {
      const auto from = grid.at(row, column);
      const auto to = grid.at(row + rows, column + columns);
      if (from < 0 || to < 0) continue;
      steps.push_back(view.kind == ScanView::Kind::unknown ? (points[to] - points[from]).norm()
                                                           : ray_step(view, points[from], points[to]).across);
    }
  return median(steps);
}

double neighbor_spacing(const RangeScan& scan) {
  constexpr std::size_t nearest = 4;  // the neighbours at distance 1 on a square lattice
  std::vector<double> distances = mean_neighbor_distances(OrderedPoints(scan.cloud.positions), nearest);
  return median(distances);
}

}  // namespace

double point_spacing(const RangeScan& scan) {
  if (scan.cloud.size() < 2) return 0;
  if (scan.grid) {
    const ScanView view = view_or_lattice_axis(scan);
    const double along_row = lattice_step(scan, view, 0, 1);
    const double along_column = lattice_step(scan, view, 1, 0);
    if (along_row > 0 && along_column > 0) return std::sqrt(along_row * along_column);
    if (along_row > 0 || along_column > 0) return std::max(along_row, along_column);
  }
  return neighbor_spacing(scan);
}

LocalSpacing::LocalSpacing(const RangeScan& scan, double spacing) : spacing_(spacing) {
  if (scan.view.kind != ScanView::Kind::origin) return;
  origin_ = scan.view.vector;
  std::vector<double> ranges;
  ranges.reserve(scan.cloud.size());
  for (const auto& p : scan.cloud.positions) ranges.push_back((p - origin_).norm());
  median_range_ = median(ranges);
}

}  // namespace drape::ingest
