#include "lattice_normals.hpp"

#include <algorithm>
#include <cmath>

#include "drape/base/parallel.hpp"
#include "lattice_view.hpp"
#include "plane_fit.hpp"

namespace drape::ingest {
namespace {

// A neighbour further than this for each cell of distance on the grid lies across a depth edge (a surface at
// 76 degrees of incidence is still followed).
constexpr double longest_step_spacings = 4;

}  // namespace

std::vector<Eigen::Vector3f> lattice_normals(const RangeScan& scan, const LocalSpacing& spacing,
                                             double radius_cells) {
  const RangeGrid& grid = *scan.grid;
  const auto& points = scan.cloud.positions;
  std::vector<Eigen::Vector3f> normals(points.size(), Eigen::Vector3f::Zero());
  struct Offset {
    int down, right;
    int directions;  // that it leads in
    std::ptrdiff_t cells_on;
    double squared_cells;  // at least 1
  };
  constexpr int both_directions = 3;
  std::vector<Offset> offsets;
  const int reach = static_cast<int>(std::floor(radius_cells));
  for (int down = -reach; down <= reach; ++down)
    for (int right = -reach; right <= reach; ++right)
      if (const double cells = std::hypot(down, right); cells <= radius_cells)
        offsets.push_back({down, right, (down != 0 ? 1 : 0) | (right != 0 ? 2 : 0),
                           std::ptrdiff_t{down} * grid.columns + right, std::pow(std::max(1.0, cells), 2)});
  constexpr std::size_t rows_per_chunk = 8;
  parallel_for(static_cast<std::size_t>(grid.rows), rows_per_chunk, [&](std::size_t begin, std::size_t end) {
    for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row)
      for (int column = 0; column < grid.columns; ++column) {
        const std::int32_t center = grid.at(row, column);
        if (center == RangeGrid::missing) continue;
        const double step = longest_step_spacings * spacing.at(points[center]);
        const double squared_step = step * step;
        const bool inside =
            row >= reach && column >= reach && row + reach < grid.rows && column + reach < grid.columns;
        const std::int32_t* const cell =
            &grid.cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
                        static_cast<std::size_t>(column)];
        int directions = 0;
        int count = 0;
        PlaneFit plane;
        for (const Offset& offset : offsets) {
          const std::int32_t index = inside ? cell[offset.cells_on]
                                            : cell_or_missing(grid, row + offset.down, column + offset.right);
          if (index == RangeGrid::missing) continue;
          const Eigen::Vector3d to = points[index] - points[center];
          if (to.squaredNorm() > squared_step * offset.squared_cells) continue;
          plane.add(to);
          ++count;
          directions |= offset.directions;
        }
        if (count >= 5 && directions == both_directions)
          normals[static_cast<std::size_t>(center)] = plane.normal();
      }
  });
  return normals;
}

}  // namespace drape::ingest
