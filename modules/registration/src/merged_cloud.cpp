#include "merged_cloud.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <unordered_map>

#include "drape/geometry/bounding_box.hpp"

namespace drape::registration {
namespace {

// Sums of one merged point.
struct Sum {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d color = Eigen::Vector3d::Zero();
  double intensity = 0;
  double weight = 0;
  float confidence = 0;
};

struct CubeHash {
  std::size_t operator()(const std::array<std::int64_t, 3>& cube) const {
    std::uint64_t hash = 0;
    for (const std::int64_t axis : cube)
      hash = (hash ^ static_cast<std::uint64_t>(axis)) * 0x9e3779b97f4a7c15ULL;
    return static_cast<std::size_t>(hash ^ (hash >> 29));
  }
};

void add(Sum& sum, const PointCloud& cloud, std::size_t i) {
  const float confidence = cloud.confidences.empty() ? 1.0F : cloud.confidences[i];
  const double weight = std::max(static_cast<double>(confidence), 1e-3);
  sum.position += weight * cloud.positions[i];
  if (!cloud.normals.empty()) sum.normal += weight * cloud.normals[i].cast<double>();
  if (!cloud.colors.empty()) sum.color += weight * cloud.colors[i].cast<double>();
  if (!cloud.intensities.empty()) sum.intensity += weight * static_cast<double>(cloud.intensities[i]);
  sum.weight += weight;
  sum.confidence = std::max(sum.confidence, confidence);
}

void append(PointCloud& cloud, const Sum& sum, const PointCloud& like) {
  cloud.positions.push_back(sum.position / sum.weight);
  if (!like.normals.empty()) cloud.normals.push_back(sum.normal.normalized().cast<float>());
  if (!like.colors.empty()) cloud.colors.push_back((sum.color / sum.weight).cast<float>());
  if (!like.intensities.empty()) cloud.intensities.push_back(static_cast<float>(sum.intensity / sum.weight));
  if (!like.confidences.empty()) cloud.confidences.push_back(sum.confidence);
}

}  // namespace

PointCloud merged_cloud(std::span<const RangeScan> scans,
                        std::span<const std::span<const Eigen::Vector3f>> normals,
                        std::span<const Rigid3> world_from_scan, std::span<const std::uint8_t> use) {
  const auto all_have = [&](const auto& attribute) {
    for (std::size_t i = 0; i < scans.size(); ++i)
      if (use[i] != 0 && attribute(scans[i].cloud).size() != scans[i].cloud.size()) return false;
    return true;
  };
  const bool colors = all_have([](const PointCloud& c) -> const auto& { return c.colors; });
  const bool intensities = all_have([](const PointCloud& c) -> const auto& { return c.intensities; });
  PointCloud merged;
  std::size_t count = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) count += use[i] != 0 ? scans[i].cloud.size() : 0;
  merged.positions.reserve(count);
  merged.normals.reserve(count);
  merged.confidences.reserve(count);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const PointCloud& cloud = scans[i].cloud;
    if (use[i] == 0 || cloud.empty()) continue;
    const Eigen::Matrix3f rotation = world_from_scan[i].linear().cast<float>();
    for (const auto& p : cloud.positions) merged.positions.push_back(world_from_scan[i] * p);
    for (const Eigen::Vector3f& n : normals[i]) merged.normals.emplace_back((rotation * n).normalized());
    if (cloud.confidences.size() == cloud.size())
      merged.confidences.insert(merged.confidences.end(), cloud.confidences.begin(), cloud.confidences.end());
    else
      merged.confidences.insert(merged.confidences.end(), cloud.size(), 1.0F);
    if (colors) merged.colors.insert(merged.colors.end(), cloud.colors.begin(), cloud.colors.end());
    if (intensities)
      merged.intensities.insert(merged.intensities.end(), cloud.intensities.begin(), cloud.intensities.end());
  }
  return merged;
}

PointCloud thinned(const PointCloud& cloud, double cell) {
  if (cloud.empty() || !(cell > 0)) return cloud;
  const Eigen::Vector3d corner = bounding_box(cloud.positions).min();
  // Per cube the first sum and the one that faces it; -1 for none.
  std::unordered_map<std::array<std::int64_t, 3>, std::array<std::ptrdiff_t, 2>, CubeHash> cubes;
  std::vector<Sum> sums;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d scaled = ((cloud.positions[i] - corner) / cell).array().floor();
    const std::array<std::int64_t, 3> cube{static_cast<std::int64_t>(scaled.x()),
                                           static_cast<std::int64_t>(scaled.y()),
                                           static_cast<std::int64_t>(scaled.z())};
    auto& slots = cubes.try_emplace(cube, std::array<std::ptrdiff_t, 2>{-1, -1}).first->second;
    const bool faces_first =
        slots[0] >= 0 && !cloud.normals.empty() &&
        sums[static_cast<std::size_t>(slots[0])].normal.dot(cloud.normals[i].cast<double>()) < 0;
    std::ptrdiff_t& slot = slots[faces_first ? 1 : 0];
    if (slot < 0) {
      slot = static_cast<std::ptrdiff_t>(sums.size());
      sums.emplace_back();
    }
    add(sums[static_cast<std::size_t>(slot)], cloud, i);
  }
  PointCloud result;
  for (const Sum& sum : sums) append(result, sum, cloud);
  return result;
}

}  // namespace drape::registration
