// What cleaning a scan and finding its normals costs, with and without a grid.
//
//   cleaning_benchmark [points in thousands ...]      default: 360 1500
#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <string>
#include <vector>

#include "drape/base/numbers.hpp"
#include "drape/base/random.hpp"
#include "drape/ingest/clean_scan.hpp"

namespace drape {
namespace {

// A wavy square seen straight on, with noise and one stray in a thousand.
RangeScan waves(std::size_t thousands, bool grid) {
  const int side = static_cast<int>(std::sqrt(1000.0 * static_cast<double>(thousands)));
  Rng rng(1);
  RangeScan scan;
  scan.view = {ScanView::Kind::direction, -Eigen::Vector3d::UnitZ()};
  if (grid) scan.grid = RangeGrid{side, side, {}};
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const double x = column + 0.1 * rng.normal();
      const double y = row + 0.1 * rng.normal();
      double z = 20 * std::sin(x / 40) * std::cos(y / 50) + 0.2 * rng.normal();
      if (rng.below(1000) == 0) z += rng.uniform(-200, 200);
      if (grid) scan.grid->cells.push_back(static_cast<std::int32_t>(scan.cloud.size()));
      scan.cloud.positions.emplace_back(x, y, z);
    }
  return scan;
}

void measure(std::size_t thousands, bool grid) {
  const RangeScan raw = waves(thousands, grid);
  const auto begin = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  const ingest::CleanedScan cleaned = ingest::clean_scan(raw, {}, {});
  const double cpu_seconds = static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  fmt::print("{:>8} points, {:<12} {:.2f} s, {:.2f} CPU s;", raw.cloud.size(),
             grid ? "with a grid" : "no grid", seconds, cpu_seconds);
  for (const auto& [filter, count] : cleaned.dropped)
    if (count > 0) fmt::print(" {} {}", count, filter);
  fmt::print("\n");
}

}  // namespace
}  // namespace drape

int main(int count, char** texts) {
  std::vector<std::size_t> sizes;
  for (int i = 1; i < count; ++i)
    if (const auto size = drape::parse_integer(texts[i]); size && *size > 0)
      sizes.push_back(static_cast<std::size_t>(*size));
    else
      return fmt::print("usage: cleaning_benchmark [points in thousands ...]\n"), 64;
  if (sizes.empty()) sizes = {360, 1500};
  for (const std::size_t size : sizes)
    for (const bool grid : {false, true}) drape::measure(size, grid);
  return 0;
}
