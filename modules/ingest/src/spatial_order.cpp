#include "drape/ingest/spatial_order.hpp"

#include <algorithm>
#include <tuple>

#include "drape/geometry/bounding_box.hpp"

namespace drape::ingest {
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

}  // namespace

std::vector<std::uint32_t> morton_order(std::span<const Eigen::Vector3d> points) {
  if (points.empty()) return {};
  const BoundingBox box = bounding_box(points);
  const double longest = box.sizes().maxCoeff();
  const double cells_per_length = longest > 0 ? 0x1fffff / longest : 0.0;
  struct Entry {
    std::uint64_t code;
    std::uint32_t index;
  };
  std::vector<Entry> entries(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d cell = (points[i] - box.min()) * cells_per_length;
    entries[i] = {spread(static_cast<std::uint64_t>(cell.x())) |
                      spread(static_cast<std::uint64_t>(cell.y())) << 1 |
                      spread(static_cast<std::uint64_t>(cell.z())) << 2,
                  i};
  }
  std::sort(entries.begin(), entries.end(), [&](const Entry& a, const Entry& b) {
    if (a.code != b.code) return a.code < b.code;
    const Eigen::Vector3d& p = points[a.index];
    const Eigen::Vector3d& q = points[b.index];
    return std::tuple(p.x(), p.y(), p.z(), a.index) < std::tuple(q.x(), q.y(), q.z(), b.index);
  });
  std::vector<std::uint32_t> order(points.size());
  std::transform(entries.begin(), entries.end(), order.begin(), [](const Entry& e) { return e.index; });
  return order;
}

}  // namespace drape::ingest
