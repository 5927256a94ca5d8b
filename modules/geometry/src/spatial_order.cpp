#include "drape/geometry/spatial_order.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include "drape/base/parallel.hpp"
#include "drape/geometry/bounding_box.hpp"

namespace drape {
namespace {

// Puts two zero bits between the lower 21 bits of x.
std::uint64_t spread(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  x = (x | x << 2) & 0x1249249249249249;
  return x;
}

struct Entry {
  std::uint64_t code;
  std::uint32_t index;
};

// 11 bits an axis: a point or two to a code on most surfaces, whose order is left to a comparison.
constexpr unsigned low_bits = 30;

// A radix sort by what lies above the low bits, lowest digits first; digits that all codes share are passed
// over.
void sort_by_high_code(std::vector<Entry>& entries) {
  constexpr unsigned digit_bits = 11;
  constexpr std::size_t digits = std::size_t{1} << digit_bits;
  std::vector<Entry> sorted(entries.size());
  for (unsigned shift = low_bits; shift < 63; shift += digit_bits) {
    std::array<std::size_t, digits> place{};
    const auto digit = [&](const Entry& e) { return e.code >> shift & (digits - 1); };
    for (const Entry& e : entries) ++place[digit(e)];
    if (place[digit(entries[0])] == entries.size()) continue;
    std::exclusive_scan(place.begin(), place.end(), place.begin(), std::size_t{0});
    for (const Entry& e : entries) sorted[place[digit(e)]++] = e;
    entries.swap(sorted);
  }
}

}  // namespace

std::vector<std::uint32_t> morton_order(std::span<const Eigen::Vector3d> points) {
  if (points.empty()) return {};
  const BoundingBox box = bounding_box(points);
  const double longest = box.sizes().maxCoeff();
  const double cells_per_length = longest > 0 ? 0x1fffff / longest : 0.0;
  std::vector<Entry> entries(points.size());
  constexpr std::size_t chunk = 1 << 14;
  parallel_for(points.size(), chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d cell = (points[i] - box.min()) * cells_per_length;
      entries[i] = {spread(static_cast<std::uint64_t>(cell.x())) |
                        spread(static_cast<std::uint64_t>(cell.y())) << 1 |
                        spread(static_cast<std::uint64_t>(cell.z())) << 2,
                    static_cast<std::uint32_t>(i)};
    }
  });
  sort_by_high_code(entries);
  // Points of one code, few if any, by their coordinates.
  for (auto first = entries.begin(); first != entries.end();) {
    const std::uint64_t high = first->code >> low_bits;
    auto last = first + 1;
    while (last != entries.end() && last->code >> low_bits == high) ++last;
    if (last - first > 1)
      std::sort(first, last, [&](const Entry& a, const Entry& b) {
        if (a.code != b.code) return a.code < b.code;
        const Eigen::Vector3d& p = points[a.index];
        const Eigen::Vector3d& q = points[b.index];
        return std::tuple(p.x(), p.y(), p.z(), a.index) < std::tuple(q.x(), q.y(), q.z(), b.index);
      });
    first = last;
  }
  std::vector<std::uint32_t> order(points.size());
  std::transform(entries.begin(), entries.end(), order.begin(), [](const Entry& e) { return e.index; });
  return order;
}

}  // namespace drape
