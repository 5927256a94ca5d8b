#include "islands.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "drape/base/disjoint_sets.hpp"
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

using Cube = std::array<std::int32_t, 3>;

// Far beyond what a scan measures, all lies in one cube.
Cube cube_at(const Eigen::Vector3d& place) {
  constexpr double furthest = 1 << 30;
  const Eigen::Vector3d cell = place.array().floor().max(-furthest).min(furthest);
  return {static_cast<std::int32_t>(cell.x()), static_cast<std::int32_t>(cell.y()),
          static_cast<std::int32_t>(cell.z())};
}

// The group of each cube, by joining those that touch; `cubes` is sorted.
std::vector<std::uint32_t> groups_of(const std::vector<Cube>& cubes) {
  DisjointSets sets(cubes.size());
  const auto join = [&](std::size_t one, std::size_t other) {
    sets.join(static_cast<std::uint32_t>(one), static_cast<std::uint32_t>(other));
  };
  // Half of the cubes around come before it. Those that differ in z only lie side by side in the sorted list,
  // and what is looked for moves along the list as the cube itself does.
  constexpr std::array<std::array<std::int32_t, 2>, 4> before{{{-1, -1}, {-1, 0}, {-1, 1}, {0, -1}}};
  std::array<std::size_t, before.size()> at{};
  for (std::size_t i = 0; i < cubes.size(); ++i) {
    const auto& [x, y, z] = cubes[i];
    if (i > 0 && cubes[i - 1] == Cube{x, y, z - 1}) join(i, i - 1);
    for (std::size_t k = 0; k < before.size(); ++k) {
      const std::int32_t column_x = x + before[k][0];
      const std::int32_t column_y = y + before[k][1];
      while (cubes[at[k]] < Cube{column_x, column_y, z - 1}) ++at[k];  // ends at the cube itself
      for (std::size_t other = at[k];
           cubes[other][0] == column_x && cubes[other][1] == column_y && cubes[other][2] <= z + 1; ++other)
        join(i, other);
    }
  }
  std::vector<std::uint32_t> groups;
  groups.reserve(cubes.size());
  for (std::uint32_t i = 0; i < cubes.size(); ++i) groups.push_back(sets.find(i));
  return groups;
}

// Points that follow each other within one cube.
struct Run {
  Cube cube;
  std::uint32_t begin;
  std::uint32_t end;
};

std::vector<Run> runs_of(const std::vector<Eigen::Vector3d>& coordinates,
                         std::span<const std::uint32_t> order, double gap) {
  constexpr std::size_t chunk = 1 << 14;
  std::vector<std::vector<Run>> of_chunk((order.size() + chunk - 1) / chunk);
  parallel_for(order.size(), chunk, [&](std::size_t begin, std::size_t end) {
    std::vector<Run>& runs = of_chunk[begin / chunk];
    for (std::size_t k = begin; k < end; ++k) {
      const Cube cube = cube_at((coordinates[order[k]] - coordinates[0]) / gap);
      if (runs.empty() || runs.back().cube != cube)
        runs.push_back({cube, static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(k)});
      runs.back().end = static_cast<std::uint32_t>(k + 1);
    }
  });
  std::vector<Run> runs;
  for (const std::vector<Run>& some : of_chunk) runs.insert(runs.end(), some.begin(), some.end());
  return runs;
}

}  // namespace

std::vector<std::uint8_t> small_islands(const RangeScan& scan, const ScanView& view, double spacing,
                                        double gap_spacings, std::size_t least_points,
                                        std::span<const std::uint32_t> order) {
  std::vector<std::uint8_t> small(scan.cloud.size(), 0);
  if (scan.cloud.empty() || !(spacing > 0) || least_points < 2) return small;
  const std::vector<Eigen::Vector3d> coordinates = sample_coordinates(scan, view, spacing);
  std::vector<Run> runs = runs_of(coordinates, order, gap_spacings);
  std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.cube < b.cube; });
  std::vector<Cube> cubes;
  std::vector<std::uint32_t> points;  // of each cube
  for (const Run& run : runs) {
    if (cubes.empty() || cubes.back() != run.cube) {
      cubes.push_back(run.cube);
      points.push_back(0);
    }
    points.back() += run.end - run.begin;
  }
  const std::vector<std::uint32_t> group = groups_of(cubes);
  std::vector<std::size_t> size(cubes.size(), 0);  // of each group
  for (std::size_t c = 0; c < cubes.size(); ++c) size[group[c]] += points[c];
  const auto largest = static_cast<std::uint32_t>(std::max_element(size.begin(), size.end()) - size.begin());
  std::size_t cube = 0;
  for (const Run& run : runs) {
    while (cubes[cube] != run.cube) ++cube;
    if (group[cube] == largest || size[group[cube]] >= least_points) continue;
    for (std::uint32_t k = run.begin; k < run.end; ++k) small[order[k]] = 1;
  }
  return small;
}

}  // namespace drape::ingest
