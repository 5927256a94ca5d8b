#include "space_carving.hpp"

#include <algorithm>
#include <cmath>

#include "drape/base/error.hpp"
#include "drape/base/parallel.hpp"
#include "drape/geometry/bounding_box.hpp"

namespace drape::meshing {
namespace {

constexpr int margin_blocks = 1;

// Per pixel of a map, whether a vertex of the open surface is seen there or beside.
std::vector<std::uint8_t> covered_pixels(const DepthMap& map, const TriangleMesh& open) {
  constexpr int beside = 2;
  std::vector<std::uint8_t> covered(map.pixels.size(), 0);
  for (const Eigen::Vector3d& vertex : open.vertices) {
    const Eigen::Vector3d picture = map.sight.picture_of(vertex);
    if (!map.sight.parallel && !(picture.z() > 0)) continue;
    if (!(picture.x() > -beside && picture.y() > -beside && picture.x() < map.columns + beside &&
          picture.y() < map.rows + beside))
      continue;
    const int column = static_cast<int>(std::lround(picture.x()));
    const int row = static_cast<int>(std::lround(picture.y()));
    for (int r = std::max(0, row - beside); r <= std::min(map.rows - 1, row + beside); ++r)
      for (int c = std::max(0, column - beside); c <= std::min(map.columns - 1, column + beside); ++c)
        covered[map.index(c, r)] = 1;
  }
  return covered;
}

bool seen_empty(const BlockSight& sight, const std::vector<std::uint8_t>& covered,
                const Eigen::Vector3f& at) {
  const DepthMap& map = sight.map();
  const Eigen::Vector3f picture = sight.picture_of(at);
  if (!(picture.x() >= 0 && picture.y() >= 0 && picture.x() < static_cast<float>(map.columns - 1) &&
        picture.y() < static_cast<float>(map.rows - 1)))
    return false;
  const Eigen::Vector4f pixel = map.at(picture.x(), picture.y());
  if (pixel[3] > 0) return pixel[0] > picture.z();
  return covered[map.index(static_cast<int>(picture.x() + 0.5F), static_cast<int>(picture.y() + 0.5F))] == 0;
}

// The lattice's blocks in the box of the surface, in the order of their keys, and a layer round them.
FusionBlocks blocks_of_box(const FusionBlocks& seen, const TriangleMesh& open) {
  constexpr std::int64_t most_blocks = 4'000'000;
  const BoundingBox box = bounding_box(open.vertices);
  const double side = seen.lattice.voxel * VoxelLattice::block;
  const auto place = [&](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(((p - seen.lattice.origin) / side).array().floor()).cast<std::int64_t>().eval();
  };
  // The lattice begins a block before the first sample, so that there is room for the layer.
  const auto low = (place(box.min()).array() - margin_blocks).max(0).eval();
  const auto high = (place(box.max()).array() + margin_blocks).eval();
  if ((high - low + 1).prod() > most_blocks)
    throw input_error("mesh.closed would look at {} blocks of voxels, more than {}: make the voxels larger",
                      (high - low + 1).prod(), most_blocks);
  FusionBlocks blocks;
  blocks.lattice = seen.lattice;
  blocks.first.push_back(0);
  for (std::int64_t z = low[2]; z <= high[2]; ++z)
    for (std::int64_t y = low[1]; y <= high[1]; ++y)
      for (std::int64_t x = low[0]; x <= high[0]; ++x) {
        blocks.keys.push_back(BlockKey(x, y, z).number());
        if (const std::uint32_t known = seen.find(blocks.keys.back()); known != FusionBlocks::none) {
          const auto maps = seen.maps_of(known);
          blocks.maps.insert(blocks.maps.end(), maps.begin(), maps.end());
        }
        blocks.first.push_back(static_cast<std::uint32_t>(blocks.maps.size()));
      }
  return blocks;
}

}  // namespace

CarvedSpace carved_space(const FusionBlocks& blocks, const FusedField& field, std::span<const DepthMap> maps,
                         const TriangleMesh& open, const Progress& progress) {
  std::vector<std::vector<std::uint8_t>> covered(maps.size());
  parallel_for(maps.size(), 1,
               [&](std::size_t m, std::size_t) { covered[m] = covered_pixels(maps[m], open); });
  CarvedSpace carved{blocks_of_box(blocks, open), {}};
  carved.field.distances.assign(carved.blocks.size() * VoxelLattice::block_voxels, FusedField::farthest);
  const Eigen::Vector3i low = BlockKey(carved.blocks.keys.front()).place();
  const Eigen::Vector3i high = BlockKey(carved.blocks.keys.back()).place();

  const auto carve = [&](std::size_t b) {
    const Eigen::Vector3i place = BlockKey(carved.blocks.keys[b]).place();
    if ((place.array() == low.array()).any() || (place.array() == high.array()).any()) return;
    std::vector<BlockSight> sights;
    for (const DepthMap& map : maps) sights.emplace_back(map, blocks.lattice, carved.blocks.corner(b));
    const std::uint32_t known = blocks.find(carved.blocks.keys[b]);
    for (int i = 0; i < VoxelLattice::block_voxels; ++i) {
      const std::int16_t fused = known == FusionBlocks::none
                                     ? FusedField::unknown
                                     : field.of_block(known)[static_cast<std::size_t>(i)];
      std::int16_t& value =
          carved.field.distances[b * VoxelLattice::block_voxels + static_cast<std::size_t>(i)];
      if (fused != FusedField::unknown) {
        value = FusedField::is_guess(fused) ? static_cast<std::int16_t>(fused + 1) : fused;
        continue;
      }
      const Eigen::Vector3f at = Eigen::Vector3i(i % 8, i / 8 % 8, i / 64).cast<float>();
      bool empty = false;
      for (std::size_t m = 0; m < sights.size() && !empty; ++m) empty = seen_empty(sights[m], covered[m], at);
      if (!empty) value = static_cast<std::int16_t>(-FusedField::farthest);
    }
  };
  constexpr std::size_t blocks_per_round = 32768;
  for (std::size_t begin = 0; begin < carved.blocks.size(); begin += blocks_per_round) {
    progress.update(static_cast<double>(begin) / static_cast<double>(carved.blocks.size()), "carving");
    const std::size_t count = std::min(blocks_per_round, carved.blocks.size() - begin);
    parallel_for(count, 64, [&](std::size_t from, std::size_t to) {
      for (std::size_t b = begin + from; b < begin + to; ++b) carve(b);
    });
  }
  return carved;
}

}  // namespace drape::meshing
