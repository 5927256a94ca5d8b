#include "drape/ingest/point_spacing.hpp"

#include <algorithm>
#include <cmath>

#include "drape/base/parallel.hpp"
#include "lattice_view.hpp"
#include "neighborhoods.hpp"
#include "spacing_parts.hpp"

namespace drape::ingest {
namespace {

double median(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Median distance across the rays of points that lie `rows` and `columns` cells apart, by a part of the rows
// where there are very many.
double lattice_step(const RangeScan& scan, const ScanView& view, int rows, int columns) {
  constexpr std::size_t enough = 20'000;  // a median needs no more
  const auto& points = scan.cloud.positions;
  const RangeGrid& grid = *scan.grid;
  const int stride = std::max(1, static_cast<int>(points.size() / enough));
  std::vector<double> steps;
  for (int row = 0; row + rows < grid.rows; row += stride)
    for (int column = 0; column + columns < grid.columns; ++column) {
      const auto from = grid.at(row, column);
      const auto to = grid.at(row + rows, column + columns);
      if (from < 0 || to < 0) continue;
      steps.push_back(view.kind == ScanView::Kind::unknown ? (points[to] - points[from]).norm()
                                                           : ray_step(view, points[from], points[to]).across);
    }
  return median(steps);
}

}  // namespace

std::optional<double> lattice_spacing(const RangeScan& scan) {
  if (!scan.grid) return std::nullopt;
  const ScanView view = view_or_lattice_axis(scan);
  const double along_row = lattice_step(scan, view, 0, 1);
  const double along_column = lattice_step(scan, view, 1, 0);
  if (along_row > 0 && along_column > 0) return std::sqrt(along_row * along_column);
  if (along_row > 0 || along_column > 0) return std::max(along_row, along_column);
  return std::nullopt;
}

double neighbor_spacing(const OrderedPoints& points, const std::vector<std::uint8_t>& dropped) {
  constexpr std::size_t nearest = 4;    // the neighbours at distance 1 on a square lattice
  constexpr std::size_t places = 8000;  // a median needs no more
  const std::size_t stride = std::max<std::size_t>(1, points.size() / places);
  const auto is_dropped = [&](std::size_t i) { return !dropped.empty() && dropped[points.original(i)] != 0; };
  std::vector<double> mean(points.size() / stride + 1, -1);
  constexpr std::size_t chunk = 512;
  parallel_for(mean.size(), chunk, [&](std::size_t begin, std::size_t end) {
    std::vector<Near> found;
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t i = k * stride;
      if (i >= points.size() || is_dropped(i)) continue;
      nearest_kept(points, points.points()[i], nearest + 1, dropped, found);
      double sum = 0;
      for (std::size_t n = 1; n < found.size(); ++n)
        sum += std::sqrt(static_cast<double>(found[n].squared_distance()));
      if (found.size() > 1) mean[k] = sum / static_cast<double>(found.size() - 1);
    }
  });
  std::erase_if(mean, [](double distance) { return distance < 0; });
  return median(mean);
}

double point_spacing(const RangeScan& scan) {
  if (scan.cloud.size() < 2) return 0;
  if (const auto spacing = lattice_spacing(scan)) return *spacing;
  return neighbor_spacing(OrderedPoints(scan.cloud.positions));
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
