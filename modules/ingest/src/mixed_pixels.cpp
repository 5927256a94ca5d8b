#include "mixed_pixels.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "drape/base/parallel.hpp"
#include "lattice_view.hpp"

namespace drape::ingest {
namespace {

enum class Step { missing, level, steep_back, steep_front };  // where the neighbour lies, seen from the point

constexpr std::array<std::array<int, 2>, 4> directions{{{0, 1}, {1, 0}, {1, 1}, {1, -1}}};

bool hangs_between(const std::array<Step, 8>& steps) {
  int level = 0;
  bool front = false;
  bool back = false;
  for (std::size_t d = 0; d < directions.size(); ++d) {
    const Step ahead = steps[2 * d];
    const Step behind = steps[2 * d + 1];
    if ((ahead == Step::steep_back && behind == Step::steep_front) ||
        (ahead == Step::steep_front && behind == Step::steep_back))
      return true;
    for (const Step step : {ahead, behind}) {
      level += step == Step::level ? 1 : 0;
      front |= step == Step::steep_front;
      back |= step == Step::steep_back;
    }
  }
  return front && back && level <= 1;
}

}  // namespace

std::vector<std::uint8_t> mixed_pixels(const RangeScan& scan, const ScanView& view, double angle_deg) {
  std::vector<std::uint8_t> mixed(scan.cloud.size(), 0);
  if (!scan.grid || view.kind == ScanView::Kind::unknown || angle_deg >= 90) return mixed;
  const RangeGrid& grid = *scan.grid;
  const auto& points = scan.cloud.positions;
  const double steepness = std::tan(angle_deg * std::numbers::pi / 180);
  // A difference of two noisy ranges deviates by sqrt(2) sigma: 6 sigma are 4.2 of its own deviations.
  const double least_jump = 6 * range_noise(scan, view);

  const auto step_to = [&](std::int32_t from, std::int32_t to) {
    if (to == RangeGrid::missing) return Step::missing;
    const RayStep step = ray_step(view, points[from], points[to]);
    if (std::abs(step.along) <= steepness * step.across || std::abs(step.along) <= least_jump)
      return Step::level;
    return step.along > 0 ? Step::steep_back : Step::steep_front;
  };
  constexpr std::size_t rows_per_chunk = 16;
  parallel_for(static_cast<std::size_t>(grid.rows), rows_per_chunk, [&](std::size_t begin, std::size_t end) {
    for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row)
      for (int column = 0; column < grid.columns; ++column) {
        const std::int32_t index = grid.at(row, column);
        if (index == RangeGrid::missing) continue;
        std::array<Step, 8> steps{};
        for (std::size_t d = 0; d < directions.size(); ++d) {
          const auto [down, right] = directions[d];
          steps[2 * d] = step_to(index, cell_or_missing(grid, row + down, column + right));
          steps[2 * d + 1] = step_to(index, cell_or_missing(grid, row - down, column - right));
        }
        mixed[static_cast<std::size_t>(index)] = hangs_between(steps) ? 1 : 0;
      }
  });
  return mixed;
}

}  // namespace drape::ingest
