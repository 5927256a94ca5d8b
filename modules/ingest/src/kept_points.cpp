#include "kept_points.hpp"

#include <algorithm>
#include <cassert>

namespace drape::ingest {
namespace {

template <class T>
void compact(std::vector<T>& values, const std::vector<std::uint8_t>& drop) {
  if (values.empty()) return;
  assert(values.size() == drop.size());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (drop[i] == 0) values[kept++] = values[i];
  values.resize(kept);
}

}  // namespace

RangeScan without_points(RangeScan scan, const std::vector<std::uint8_t>& drop) {
  assert(drop.size() == scan.cloud.size());
  if (std::find(drop.begin(), drop.end(), std::uint8_t{1}) == drop.end()) return scan;
  compact(scan.cloud.positions, drop);
  compact(scan.cloud.normals, drop);
  compact(scan.cloud.colors, drop);
  compact(scan.cloud.intensities, drop);
  compact(scan.cloud.confidences, drop);
  if (!scan.grid) return scan;

  std::vector<std::int32_t> new_index(drop.size(), RangeGrid::missing);
  std::int32_t kept = 0;
  for (std::size_t i = 0; i < drop.size(); ++i)
    if (drop[i] == 0) new_index[i] = kept++;
  for (std::int32_t& cell : scan.grid->cells)
    if (cell != RangeGrid::missing) cell = new_index[static_cast<std::size_t>(cell)];
  return scan;
}

}  // namespace drape::ingest
