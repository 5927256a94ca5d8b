#include "point_filters.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <tuple>

#include "drape/geometry/bounding_box.hpp"

namespace drape::ingest {

std::vector<std::uint8_t> outside_of_box(const RangeScan& scan, std::span<const double> box) {
  std::vector<std::uint8_t> outside(scan.cloud.size(), 0);
  if (box.empty()) return outside;
  const BoundingBox kept(Eigen::Vector3d(box[0], box[1], box[2]), Eigen::Vector3d(box[3], box[4], box[5]));
  for (std::size_t i = 0; i < outside.size(); ++i)
    outside[i] = kept.contains(scan.cloud.positions[i]) ? 0 : 1;
  return outside;
}

std::vector<std::uint8_t> outside_of_intensities(const RangeScan& scan, double least, double most) {
  std::vector<std::uint8_t> outside(scan.cloud.size(), 0);
  for (std::size_t i = 0; i < scan.cloud.intensities.size(); ++i) {
    const auto intensity = static_cast<double>(scan.cloud.intensities[i]);
    outside[i] = intensity < least || intensity > most ? 1 : 0;
  }
  return outside;
}

std::vector<std::uint8_t> all_but_best_seen(const PointCloud& cloud, double voxel) {
  std::vector<std::uint8_t> dropped(cloud.size(), 0);
  if (!(voxel > 0) || cloud.empty()) return dropped;
  const Eigen::Vector3d corner = bounding_box(cloud.positions).min();
  struct Entry {
    std::array<std::int64_t, 3> voxel;
    float confidence;
    std::uint32_t index;
  };
  std::vector<Entry> entries;
  entries.reserve(cloud.size());
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d place = (cloud.positions[i] - corner) / voxel;
    entries.push_back({{static_cast<std::int64_t>(place.x()), static_cast<std::int64_t>(place.y()),
                        static_cast<std::int64_t>(place.z())},
                       cloud.confidences.empty() ? 1.0F : cloud.confidences[i],
                       i});
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tuple(a.voxel, -a.confidence, a.index) < std::tuple(b.voxel, -b.confidence, b.index);
  });
  for (std::size_t k = 1; k < entries.size(); ++k)
    if (entries[k].voxel == entries[k - 1].voxel) dropped[entries[k].index] = 1;
  return dropped;
}

}  // namespace drape::ingest
