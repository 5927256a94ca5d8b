// Where there is surface: small cubes of voxels, each with the depth maps that see surface in it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "depth_map.hpp"

namespace drape::meshing {

/// The cubic lattice of voxels that a mesh is made on. Voxel (0, 0, 0) lies at `origin`.
struct VoxelLattice {
  static constexpr int block = 8;                             // voxels along a block's side
  static constexpr int block_voxels = block * block * block;  // (z * block + y) * block + x
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();           // world
  double voxel = 1;

  [[nodiscard]] Eigen::Vector3d position(const Eigen::Vector3d& in_voxels) const {
    return origin + voxel * in_voxels;
  }
};

/// A block's place in the lattice, in one number that grows with z, then y, then x.
class BlockKey {
 public:
  static constexpr int bits = 21;
  static constexpr std::int64_t most = (std::int64_t{1} << bits) - 1;
  BlockKey(std::int64_t x, std::int64_t y, std::int64_t z)
      : key_(static_cast<std::uint64_t>((z << (2 * bits)) | (y << bits) | x)) {}
  explicit BlockKey(std::uint64_t key) : key_(key) {}

  [[nodiscard]] std::uint64_t number() const { return key_; }
  [[nodiscard]] Eigen::Vector3i place() const {
    const auto part = [&](int shift) {
      return static_cast<int>((key_ >> shift) & static_cast<std::uint64_t>(most));
    };
    return {part(0), part(bits), part(2 * bits)};
  }

 private:
  std::uint64_t key_;
};

struct FusionBlocks {
  static constexpr std::uint32_t none = 0xffffffffU;

  VoxelLattice lattice;
  std::vector<std::uint64_t> keys;   // increasing
  std::vector<std::uint32_t> first;  // block b is seen by maps[first[b]] .. maps[first[b + 1] - 1]
  std::vector<std::uint32_t> maps;

  [[nodiscard]] std::size_t size() const { return keys.size(); }
  [[nodiscard]] std::span<const std::uint32_t> maps_of(std::size_t block) const {
    return {maps.data() + first[block], first[block + 1] - first[block]};
  }
  /// Of the block's voxel (0, 0, 0), in voxels.
  [[nodiscard]] Eigen::Vector3i corner(std::size_t block) const {
    return BlockKey(keys[block]).place() * VoxelLattice::block;
  }
  /// The block with that key, or `none`.
  [[nodiscard]] std::uint32_t find(std::uint64_t key) const;
  /// Itself, and its neighbours at +1 in x (bit 0), y (bit 1), z (bit 2).
  [[nodiscard]] std::array<std::uint32_t, 8> upper_neighbors(std::size_t block) const;
};

/// All blocks within `reach` voxels of a pixel of a map. Error{input} where the lattice would have more than
/// 2^21 blocks along an axis.
[[nodiscard]] FusionBlocks blocks_round(std::span<const DepthMap> maps, double voxel, double reach);

}  // namespace drape::meshing
