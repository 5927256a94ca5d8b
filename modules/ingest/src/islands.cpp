#include "islands.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include "drape/base/parallel.hpp"
#include "drape/ingest/point_spacing.hpp"

namespace drape::ingest {
namespace {

// Positions in a space where neighbouring samples of one surface are about one unit apart.
std::vector<Eigen::Vector3d> sample_coordinates(const RangeScan& scan, const ScanView& view, double spacing) {
  const auto& points = scan.cloud.positions;
  std::vector<Eigen::Vector3d> result(points.size());
  if (!scan.grid || view.kind == ScanView::Kind::unknown) {
    // Without a grid the sparsest samples of a diverging scan set the scale: too few islands, never torn
    // walls.
    const LocalSpacing local(scan, spacing);
    double unit = spacing;
    if (scan.view.kind == ScanView::Kind::origin)
      for (const auto& p : points) unit = std::max(unit, local.at(p));
    constexpr std::size_t chunk = 1 << 14;
    parallel_for(points.size(), chunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) result[i] = points[i] / unit;
    });
    return result;
  }
  const LocalSpacing local(scan, spacing);
  constexpr std::size_t rows_per_chunk = 16;
  parallel_for(static_cast<std::size_t>(scan.grid->rows), rows_per_chunk,
               [&](std::size_t begin, std::size_t end) {
                 for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row)
                   for (int column = 0; column < scan.grid->columns; ++column) {
                     const auto index = scan.grid->at(row, column);
                     if (index == RangeGrid::missing) continue;
                     const Eigen::Vector3d& p = points[index];
                     // A step of one local spacing in range is the same step of log(range) everywhere.
                     const double depth = view.kind == ScanView::Kind::direction
                                              ? view.vector.dot(p) / spacing
                                              : std::log(std::max((p - view.vector).norm(), 1e-300)) *
                                                    (p - view.vector).norm() / local.at(p);
                     result[static_cast<std::size_t>(index)] = Eigen::Vector3d(row, column, depth);
                   }
               });
  return result;
}

using Cube = std::array<std::int64_t, 3>;

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t node) {
  while (parent[node] != node) node = parent[node] = parent[parent[node]];
  return node;
}

// The group of each cube, by joining those that touch; `cubes` is sorted.
std::vector<std::uint32_t> groups_of(const std::vector<Cube>& cubes) {
  std::vector<std::uint32_t> parent(cubes.size());
  std::iota(parent.begin(), parent.end(), 0U);
  for (std::uint32_t i = 0; i < cubes.size(); ++i)
    for (std::int64_t x = -1; x <= 0; ++x)
      for (std::int64_t y = -1; y <= 1; ++y) {
        // Cubes that differ in z only lie side by side in the sorted list: look up the first of three.
        Cube wanted{cubes[i][0] + x, cubes[i][1] + y, cubes[i][2] - 1};
        auto found = std::lower_bound(cubes.begin(), cubes.end(), wanted);
        for (; found != cubes.end() && (*found)[0] == wanted[0] && (*found)[1] == wanted[1] &&
               (*found)[2] <= cubes[i][2] + 1;
             ++found) {
          const auto a = root_of(parent, i);
          const auto b = root_of(parent, static_cast<std::uint32_t>(found - cubes.begin()));
          parent[std::max(a, b)] = std::min(a, b);
        }
      }
  for (std::uint32_t i = 0; i < cubes.size(); ++i) parent[i] = root_of(parent, i);
  return parent;
}

}  // namespace

std::vector<std::uint8_t> small_islands(const RangeScan& scan, const ScanView& view, double spacing,
                                        double gap_spacings, std::size_t least_points,
                                        std::span<const std::uint32_t> order) {
  std::vector<std::uint8_t> small(scan.cloud.size(), 0);
  if (scan.cloud.empty() || !(spacing > 0) || least_points < 2) return small;
  const std::vector<Eigen::Vector3d> coordinates = sample_coordinates(scan, view, spacing);
  const auto cube_of = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d cell = ((p - coordinates[0]) / gap_spacings).array().floor();
    return Cube{static_cast<std::int64_t>(cell.x()), static_cast<std::int64_t>(cell.y()),
                static_cast<std::int64_t>(cell.z())};
  };
  // Points of one cube mostly follow each other: one entry for each such run.
  struct Run {
    Cube cube;
    std::size_t end;
  };
  constexpr std::size_t chunk = 1 << 14;
  std::vector<std::vector<Run>> of_chunk((order.size() + chunk - 1) / chunk);
  parallel_for(order.size(), chunk, [&](std::size_t begin, std::size_t end) {
    std::vector<Run>& runs = of_chunk[begin / chunk];
    for (std::size_t k = begin; k < end; ++k) {
      const Cube cube = cube_of(coordinates[order[k]]);
      if (runs.empty() || runs.back().cube != cube) runs.push_back({cube, k});
      runs.back().end = k + 1;
    }
  });
  std::vector<Run> runs;
  for (const std::vector<Run>& some : of_chunk) runs.insert(runs.end(), some.begin(), some.end());
  std::vector<Cube> cubes(runs.size());
  std::transform(runs.begin(), runs.end(), cubes.begin(), [](const Run& run) { return run.cube; });
  std::sort(cubes.begin(), cubes.end());
  cubes.erase(std::unique(cubes.begin(), cubes.end()), cubes.end());
  const std::vector<std::uint32_t> group = groups_of(cubes);

  std::vector<std::uint32_t> group_of_point(coordinates.size());
  std::vector<std::size_t> size(cubes.size(), 0);
  std::size_t begin = 0;
  for (const Run& run : runs) {
    const auto cube = std::lower_bound(cubes.begin(), cubes.end(), run.cube) - cubes.begin();
    const std::uint32_t of_run = group[static_cast<std::size_t>(cube)];
    for (std::size_t k = begin; k < run.end; ++k) group_of_point[order[k]] = of_run;
    size[of_run] += run.end - begin;
    begin = run.end;
  }
  const auto largest = static_cast<std::uint32_t>(std::max_element(size.begin(), size.end()) - size.begin());
  for (std::size_t i = 0; i < small.size(); ++i)
    small[i] = group_of_point[i] != largest && size[group_of_point[i]] < least_points ? 1 : 0;
  return small;
}

}  // namespace drape::ingest
