#include "fused_attributes.hpp"

#include <algorithm>
#include <array>

#include "drape/base/parallel.hpp"
#include "fused_field.hpp"

namespace drape::meshing {
namespace {

// Red, green, blue, intensity, confidence; and the weight of all.
using Sum = Eigen::Matrix<float, 6, 1>;

// The attributes of the four samples round a place in the picture, bilinear, in their weight.
Sum at_place(const DepthMap& map, const PointCloud& cloud, const CommonAttributes& common, float column,
             float row, float weight) {
  Sum sum = Sum::Zero();
  for (int down = 0; down < 2; ++down)
    for (int right = 0; right < 2; ++right) {
      const int c = static_cast<int>(column) + right;
      const int r = static_cast<int>(row) + down;
      const std::uint32_t sample = map.samples[map.index(c, r)];
      if (sample == DepthMap::no_sample) continue;
      const float w = weight * (1 - std::abs(column - static_cast<float>(c))) *
                      (1 - std::abs(row - static_cast<float>(r)));
      if (common.colors) sum.head<3>() += w * cloud.colors[sample];
      if (common.intensities) sum[3] += w * cloud.intensities[sample];
      if (common.confidences) sum[4] += w * cloud.confidences[sample];
      sum[5] += w;
    }
  return sum;
}

}  // namespace

CommonAttributes common_attributes(std::span<const DepthMap> maps, std::span<const RangeScan> scans) {
  CommonAttributes common;
  for (const DepthMap& map : maps) {
    const PointCloud& cloud = scans[map.scan].cloud;
    common.colors &= !cloud.colors.empty();
    common.intensities &= !cloud.intensities.empty();
    common.confidences &= !cloud.confidences.empty();
  }
  return common;
}

void fuse_attributes(SurfacePart& part, const CommonAttributes& common, const FusionBlocks& blocks,
                     std::span<const DepthMap> maps, std::span<const RangeScan> scans) {
  if (!common.any()) return;
  if (common.colors) part.colors.resize(part.places.size(), Eigen::Vector3f::Zero());
  if (common.intensities) part.intensities.resize(part.places.size(), 0.0F);
  if (common.confidences) part.confidences.resize(part.places.size(), 0.0F);

  parallel_for(part.first_vertex.size() - 1, 64, [&](std::size_t begin, std::size_t end) {
    std::vector<BlockSight> sights;
    std::vector<Sighting> sightings;
    for (std::size_t k = begin; k < end; ++k) {
      if (part.first_vertex[k] == part.first_vertex[k + 1]) continue;
      const std::size_t block = part.first_block + k;
      sights.clear();
      for (const std::uint32_t m : blocks.maps_of(block))
        sights.emplace_back(maps[m], blocks.lattice, blocks.corner(block));
      sightings.resize(sights.size());
      const std::uint32_t first = part.first_vertex.front();
      for (std::uint32_t v = part.first_vertex[k] - first; v < part.first_vertex[k + 1] - first; ++v) {
        const Eigen::Vector3f& at = part.places[v];
        for (std::size_t m = 0; m < sights.size(); ++m) sightings[m] = sights[m].sighting(at);
        if (sights.size() > 1) shield_opposite_sides(sightings, sights, at);
        Sum sum = Sum::Zero();
        for (std::size_t m = 0; m < sights.size(); ++m) {
          if (!(sightings[m].weight > 0)) continue;
          const Eigen::Vector3f picture = sights[m].picture_of(at);
          const DepthMap& map = sights[m].map();
          sum += at_place(map, scans[map.scan].cloud, common, picture.x(), picture.y(), sightings[m].weight);
        }
        if (!(sum[5] > 0)) continue;
        sum /= sum[5];
        if (common.colors) part.colors[v] = sum.head<3>();
        if (common.intensities) part.intensities[v] = sum[3];
        if (common.confidences) part.confidences[v] = sum[4];
      }
    }
  });
}

}  // namespace drape::meshing
