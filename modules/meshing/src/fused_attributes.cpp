#include "fused_attributes.hpp"

#include <algorithm>
#include <array>

#include "drape/base/parallel.hpp"
#include "fused_field.hpp"

namespace drape::meshing {
namespace {

// Red, green, blue, intensity, confidence; and the weight of all.
using Sum = Eigen::Matrix<float, 6, 1>;

struct Present {
  bool colors = true;
  bool intensities = true;
  bool confidences = true;
};

// The attributes of the four samples round a place in the picture, bilinear, in their weight.
Sum at_place(const DepthMap& map, const PointCloud& cloud, const Present& present, float column, float row,
             float weight) {
  Sum sum = Sum::Zero();
  for (int down = 0; down < 2; ++down)
    for (int right = 0; right < 2; ++right) {
      const int c = static_cast<int>(column) + right;
      const int r = static_cast<int>(row) + down;
      const std::uint32_t sample = map.samples[map.index(c, r)];
      if (sample == DepthMap::no_sample) continue;
      const float w = weight * (1 - std::abs(column - static_cast<float>(c))) *
                      (1 - std::abs(row - static_cast<float>(r)));
      if (present.colors) sum.head<3>() += w * cloud.colors[sample];
      if (present.intensities) sum[3] += w * cloud.intensities[sample];
      if (present.confidences) sum[4] += w * cloud.confidences[sample];
      sum[5] += w;
    }
  return sum;
}

}  // namespace

void fuse_attributes(FieldSurface& surface, const FusionBlocks& blocks, std::span<const DepthMap> maps,
                     std::span<const RangeScan> scans) {
  Present present;
  for (const DepthMap& map : maps) {
    const PointCloud& cloud = scans[map.scan].cloud;
    present.colors &= !cloud.colors.empty();
    present.intensities &= !cloud.intensities.empty();
    present.confidences &= !cloud.confidences.empty();
  }
  TriangleMesh& mesh = surface.mesh;
  if (present.colors) mesh.colors.resize(mesh.vertices.size(), Eigen::Vector3f::Zero());
  if (present.intensities) mesh.intensities.resize(mesh.vertices.size(), 0.0F);
  if (present.confidences) mesh.confidences.resize(mesh.vertices.size(), 0.0F);
  if (!present.colors && !present.intensities && !present.confidences) return;

  parallel_for(blocks.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<BlockSight> sights;
    std::vector<Sighting> sightings;
    for (std::size_t b = begin; b < end; ++b) {
      if (surface.first_vertex[b] == surface.first_vertex[b + 1]) continue;
      sights.clear();
      for (const std::uint32_t m : blocks.maps_of(b))
        sights.emplace_back(maps[m], blocks.lattice, blocks.corner(b));
      sightings.resize(sights.size());
      const Eigen::Vector3d corner = blocks.lattice.position(blocks.corner(b).cast<double>());
      for (std::uint32_t v = surface.first_vertex[b]; v < surface.first_vertex[b + 1]; ++v) {
        const Eigen::Vector3f at = ((mesh.vertices[v] - corner) / blocks.lattice.voxel).cast<float>();
        for (std::size_t m = 0; m < sights.size(); ++m) sightings[m] = sights[m].sighting(at);
        if (sights.size() > 1) shield_opposite_sides(sightings, sights, at);
        Sum sum = Sum::Zero();
        for (std::size_t m = 0; m < sights.size(); ++m) {
          if (!(sightings[m].weight > 0)) continue;
          const Eigen::Vector3f picture = sights[m].picture_of(at);
          const DepthMap& map = sights[m].map();
          sum += at_place(map, scans[map.scan].cloud, present, picture.x(), picture.y(), sightings[m].weight);
        }
        if (!(sum[5] > 0)) continue;
        sum /= sum[5];
        if (present.colors) mesh.colors[v] = sum.head<3>();
        if (present.intensities) mesh.intensities[v] = sum[3];
        if (present.confidences) mesh.confidences[v] = sum[4];
      }
    }
  });
}

}  // namespace drape::meshing
