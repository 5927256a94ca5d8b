#include "lattice_distances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "drape/base/parallel.hpp"
#include "lattice_view.hpp"

namespace drape::ingest {
namespace {

constexpr double unsuspicious = 1.3;  // times the mean; outliers are beyond twice the mean
constexpr double unknown = std::numeric_limits<double>::infinity();

// The mean of the least `count` square roots; `squares` are reordered.
double mean_of_least(std::vector<float>& squares, std::size_t count) {
  std::nth_element(squares.begin(), squares.begin() + static_cast<std::ptrdiff_t>(count) - 1, squares.end());
  float sum = 0;
  for (std::size_t k = 0; k < count; ++k) sum += std::sqrt(squares[k]);
  return static_cast<double>(sum) / static_cast<double>(count);
}

// From the nearest around each point on the grid; unknown where there are not enough.
std::vector<double> upper_bounds(const RangeScan& scan, std::size_t neighbors) {
  const RangeGrid& grid = *scan.grid;
  const auto& points = scan.cloud.positions;
  std::vector<double> bounds(points.size(), unknown);
  int reach = 1;  // half as many again as are wanted
  while (static_cast<std::size_t>((2 * reach + 1) * (2 * reach + 1) - 1) < neighbors + neighbors / 2) ++reach;
  constexpr std::size_t rows_per_chunk = 8;
  parallel_for(static_cast<std::size_t>(grid.rows), rows_per_chunk, [&](std::size_t begin, std::size_t end) {
    std::vector<float> squares;
    for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row)
      for (int column = 0; column < grid.columns; ++column) {
        const std::int32_t center = grid.at(row, column);
        if (center == RangeGrid::missing) continue;
        squares.clear();
        for (int r = row - reach; r <= row + reach; ++r)
          for (int c = column - reach; c <= column + reach; ++c) {
            const std::int32_t index = cell_or_missing(grid, r, c);
            if (index == RangeGrid::missing || index == center) continue;
            squares.push_back(static_cast<float>((points[index] - points[center]).squaredNorm()));
          }
        if (squares.size() >= neighbors)
          bounds[static_cast<std::size_t>(center)] = mean_of_least(squares, neighbors);
      }
  });
  return bounds;
}

}  // namespace

std::vector<double> lattice_distances(const RangeScan& scan, const OrderedPoints& points,
                                      const LocalSpacing& spacing, std::size_t neighbors) {
  const auto& positions = scan.cloud.positions;
  std::vector<double> distances = upper_bounds(scan, neighbors);
  double sum = 0;
  double count = 0;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    distances[i] /= std::max(spacing.ratio(positions[i]), 1e-12);
    if (distances[i] == unknown) continue;
    sum += distances[i];
    count += 1;
  }
  const double limit = count > 0 ? unsuspicious * sum / count : 0.0;
  std::vector<std::uint32_t> suspicious;
  for (std::uint32_t i = 0; i < distances.size(); ++i)
    if (!(distances[i] <= limit)) suspicious.push_back(i);
  constexpr std::size_t chunk = 1024;
  parallel_for(suspicious.size(), chunk, [&](std::size_t begin, std::size_t end) {
    std::vector<Near> near(neighbors + 1);  // and the point itself
    for (std::size_t s = begin; s < end; ++s) {
      const Eigen::Vector3d& position = positions[suspicious[s]];
      const std::size_t found = points.nearest(position, near);
      double total = 0;
      for (std::size_t k = 0; k < found; ++k)
        total += std::sqrt(static_cast<double>(near[k].squared_distance()));
      distances[suspicious[s]] =
          found > 1 ? total / static_cast<double>(found - 1) / std::max(spacing.ratio(position), 1e-12) : 0.0;
    }
  });
  return distances;
}

}  // namespace drape::ingest
