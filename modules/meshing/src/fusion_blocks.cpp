#include "fusion_blocks.hpp"

#include <algorithm>
#include <cmath>

#include "drape/base/error.hpp"
#include "drape/base/parallel.hpp"
#include "drape/geometry/bounding_box.hpp"

namespace drape::meshing {
namespace {

// Calls visit(position in the world, half of the depth that the pixel spans) for each pixel with a value in
// some rows.
template <class Visit>
void for_each_place(const DepthMap& map, std::size_t first_row, std::size_t end_row, Visit visit) {
  const Rigid3 world_from_sight = map.sight.sight_from_world.inverse();
  for (std::size_t row = first_row; row < end_row; ++row)
    for (int column = 0; column < map.columns; ++column) {
      const Eigen::Vector4f& pixel = map.pixels[map.index(column, static_cast<int>(row))];
      if (!(pixel[3] > 0)) continue;
      const auto depth = static_cast<double>(pixel[0]);
      const Eigen::Vector3d in_sight =
          map.sight.in_sight({static_cast<double>(column), static_cast<double>(row), depth});
      const double steepness = std::hypot(static_cast<double>(pixel[1]), static_cast<double>(pixel[2]));
      visit(world_from_sight * in_sight,
            world_from_sight.linear().col(2) * (0.5 * steepness * map.sight.width_at(depth)));
    }
}

constexpr std::size_t rows_per_chunk = 64;

std::size_t chunks_of(const DepthMap& map) {
  return (static_cast<std::size_t>(map.rows) + rows_per_chunk - 1) / rows_per_chunk;
}

BoundingBox box_of(std::span<const DepthMap> maps) {
  BoundingBox all;
  for (const DepthMap& map : maps) {
    std::vector<BoundingBox> parts(chunks_of(map));
    parallel_for(static_cast<std::size_t>(map.rows), rows_per_chunk, [&](std::size_t begin, std::size_t end) {
      BoundingBox& part = parts[begin / rows_per_chunk];
      for_each_place(map, begin, end, [&](const Eigen::Vector3d& p, const Eigen::Vector3d& half) {
        part.extend(p + half);
        part.extend(p - half);
      });
    });
    for (const BoundingBox& part : parts) all.extend(part);
  }
  return all;
}

// The keys of the blocks that places reach, most repetitions left out.
class KeyCollector {
 public:
  KeyCollector(const VoxelLattice& lattice, double reach) : lattice_(lattice), reach_(reach) {}

  void add(const Eigen::Vector3d& position) {
    const Eigen::Vector3d voxels = (position - lattice_.origin) / lattice_.voxel;
    Eigen::Array<std::int64_t, 3, 1> low;
    Eigen::Array<std::int64_t, 3, 1> high;
    for (int k = 0; k < 3; ++k) {
      low[k] = static_cast<std::int64_t>(voxels[k] - reach_) / VoxelLattice::block;
      high[k] = static_cast<std::int64_t>(voxels[k] + reach_) / VoxelLattice::block;
    }
    for (std::int64_t z = low[2]; z <= high[2]; ++z)
      for (std::int64_t y = low[1]; y <= high[1]; ++y)
        for (std::int64_t x = low[0]; x <= high[0]; ++x) {
          const std::uint64_t key = BlockKey(x, y, z).number();
          std::uint64_t& known = recent_[((x & 15) << 8) | ((y & 15) << 4) | (z & 15)];
          if (known == key + 1) continue;
          known = key + 1;
          keys_.push_back(key);
        }
  }

  [[nodiscard]] std::vector<std::uint64_t> sorted() && {
    std::sort(keys_.begin(), keys_.end());
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
    return std::move(keys_);
  }

 private:
  VoxelLattice lattice_;
  double reach_;
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint64_t> recent_ = std::vector<std::uint64_t>(4096, 0);
};

std::vector<std::uint64_t> keys_of(const DepthMap& map, const VoxelLattice& lattice, double reach) {
  std::vector<std::vector<std::uint64_t>> parts(chunks_of(map));
  parallel_for(static_cast<std::size_t>(map.rows), rows_per_chunk, [&](std::size_t begin, std::size_t end) {
    KeyCollector collector(lattice, reach);
    for_each_place(map, begin, end, [&](const Eigen::Vector3d& p, const Eigen::Vector3d& half) {
      // A steep pixel's surface reaches through more than the voxels round its middle.
      const auto steps = static_cast<int>(std::ceil(half.norm() / (reach * lattice.voxel) - 0.5));
      collector.add(p);
      for (int k = 1; k <= steps; ++k) {
        collector.add(p + half * k / steps);
        collector.add(p - half * k / steps);
      }
    });
    parts[begin / rows_per_chunk] = std::move(collector).sorted();
  });
  std::vector<std::uint64_t> keys;
  for (const auto& part : parts) keys.insert(keys.end(), part.begin(), part.end());
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

}  // namespace

std::uint32_t FusionBlocks::find(std::uint64_t key) const {
  const auto place = std::lower_bound(keys.begin(), keys.end(), key);
  return place == keys.end() || *place != key ? none : static_cast<std::uint32_t>(place - keys.begin());
}

std::array<std::uint32_t, 8> FusionBlocks::upper_neighbors(std::size_t block) const {
  std::array<std::uint32_t, 8> neighbors{};
  for (std::uint32_t k = 0; k < 8; k += 2) {
    const std::uint64_t key = keys[block] + (std::uint64_t{(k >> 1) & 1} << BlockKey::bits) +
                              (std::uint64_t{k >> 2} << (2 * BlockKey::bits));
    const std::uint32_t at = k == 0 ? static_cast<std::uint32_t>(block) : find(key);
    neighbors[k] = at;
    // The next along x follows in the order of the keys.
    if (at != none)
      neighbors[k + 1] = at + 1 < keys.size() && keys[at + 1] == key + 1 ? at + 1 : none;
    else
      neighbors[k + 1] = find(key + 1);
  }
  return neighbors;
}

FusionBlocks blocks_round(std::span<const DepthMap> maps, double voxel, double reach) {
  FusionBlocks blocks;
  const BoundingBox box = box_of(maps);
  blocks.first.push_back(0);
  if (box.isEmpty()) return blocks;
  // A block's margin on all sides, so that no key is negative.
  constexpr double margin = VoxelLattice::block;
  if (!(box.sizes().maxCoeff() / voxel + 2 * margin <
        static_cast<double>(BlockKey::most) * VoxelLattice::block))
    throw input_error(
        "the scans extend over {:.3g}, which is too far for voxels of {:.3g}: is a point far off, or a pose "
        "wrong?",
        box.sizes().maxCoeff(), voxel);
  blocks.lattice.voxel = voxel;
  blocks.lattice.origin = box.min().array() - margin * voxel;

  struct Seen {
    std::uint64_t key;
    std::uint32_t map;
  };
  std::vector<Seen> seen;
  for (std::uint32_t m = 0; m < maps.size(); ++m)
    for (const std::uint64_t key : keys_of(maps[m], blocks.lattice, reach)) seen.push_back({key, m});
  std::sort(seen.begin(), seen.end(),
            [](const Seen& a, const Seen& b) { return a.key != b.key ? a.key < b.key : a.map < b.map; });
  blocks.maps.reserve(seen.size());
  for (const Seen& s : seen) {
    if (blocks.keys.empty() || blocks.keys.back() != s.key) {
      if (!blocks.keys.empty()) blocks.first.push_back(static_cast<std::uint32_t>(blocks.maps.size()));
      blocks.keys.push_back(s.key);
    }
    blocks.maps.push_back(s.map);
  }
  blocks.first.push_back(static_cast<std::uint32_t>(blocks.maps.size()));
  return blocks;
}

}  // namespace drape::meshing
