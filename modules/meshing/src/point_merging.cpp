#include "point_merging.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "drape/base/error.hpp"
#include "drape/geometry/bounding_box.hpp"

namespace drape::meshing {
namespace {

struct Keyed {
  std::array<double, 3> voxel;  // whole numbers; the coordinates themselves where nothing is to be merged
  std::uint32_t index;
};

// The sums of the samples of one side of a surface within a voxel.
struct Sum {
  std::size_t count = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d color = Eigen::Vector3d::Zero();
  double intensity = 0;
  double confidence = 0;

  void add(const PointCloud& cloud, std::uint32_t i, const Eigen::Vector3d& origin) {
    ++count;
    position += cloud.positions[i] - origin;
    if (!cloud.normals.empty()) normal += cloud.normals[i].cast<double>();
    if (!cloud.colors.empty()) color += cloud.colors[i].cast<double>();
    if (!cloud.intensities.empty()) intensity += static_cast<double>(cloud.intensities[i]);
    if (!cloud.confidences.empty()) confidence += static_cast<double>(cloud.confidences[i]);
  }

  void append_mean(const PointCloud& like, const Eigen::Vector3d& origin, PointCloud& merged) const {
    const auto n = static_cast<double>(count);
    merged.positions.push_back(origin + position / n);
    if (!like.normals.empty()) merged.normals.push_back(normal.stableNormalized().cast<float>());
    if (!like.colors.empty()) merged.colors.push_back((color / n).cast<float>());
    if (!like.intensities.empty()) merged.intensities.push_back(static_cast<float>(intensity / n));
    if (!like.confidences.empty()) merged.confidences.push_back(static_cast<float>(confidence / n));
  }
};

bool usable(const PointCloud& cloud, std::size_t i) {
  if (!cloud.positions[i].allFinite()) return false;
  return cloud.normals.empty() || (cloud.normals[i].allFinite() && cloud.normals[i].squaredNorm() > 0);
}

std::vector<Keyed> sorted_by_voxel(const PointCloud& cloud, double voxel, const Eigen::Vector3d& origin) {
  std::vector<Keyed> keyed;
  keyed.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!usable(cloud, i)) continue;
    std::array<double, 3> key{};
    for (int k = 0; k < 3; ++k)
      key[static_cast<std::size_t>(k)] =
          voxel > 0 ? std::floor((cloud.positions[i][k] - origin[k]) / voxel) : cloud.positions[i][k];
    keyed.push_back({key, static_cast<std::uint32_t>(i)});
  }
  std::sort(keyed.begin(), keyed.end(), [](const Keyed& a, const Keyed& b) {
    return a.voxel != b.voxel ? a.voxel < b.voxel : a.index < b.index;
  });
  return keyed;
}

}  // namespace

PointCloud merged_on_voxels(const PointCloud& cloud, double voxel) {
  if (cloud.size() > std::numeric_limits<std::uint32_t>::max())
    throw input_error("{} samples are more than meshing can number", cloud.size());
  PointCloud merged;
  const BoundingBox box = bounding_box(cloud.positions);
  if (box.isEmpty()) return merged;
  const std::vector<Keyed> keyed = sorted_by_voxel(cloud, voxel, box.min());
  for (std::size_t begin = 0; begin < keyed.size();) {
    Sum near_side;
    Sum far_side;
    const std::uint32_t first = keyed[begin].index;
    std::size_t end = begin;
    for (; end < keyed.size() && keyed[end].voxel == keyed[begin].voxel; ++end) {
      const std::uint32_t i = keyed[end].index;
      const bool opposite = !cloud.normals.empty() && cloud.normals[i].dot(cloud.normals[first]) < 0;
      (opposite ? far_side : near_side).add(cloud, i, box.min());
    }
    near_side.append_mean(cloud, box.min(), merged);
    if (far_side.count > 0) far_side.append_mean(cloud, box.min(), merged);
    begin = end;
  }
  return merged;
}

}  // namespace drape::meshing
