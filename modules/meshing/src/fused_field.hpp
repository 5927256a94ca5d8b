// The signed distance to the surface that all scans agree on.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "depth_map.hpp"
#include "drape/base/progress.hpp"
#include "fusion_blocks.hpp"

namespace drape::meshing {

/// Distances at the voxels of the blocks: positive in front of the surface, in steps of `step_voxels`. Odd
/// ones are positive too, and guesses: space beside or far in front of a surface that its scan saw through.
struct FusedField {
  static constexpr double truncation_voxels = 3;
  static constexpr std::int16_t unknown = -32768;  // no scan saw what is there
  static constexpr std::int16_t farthest = 32766;  // of what is known
  static constexpr bool is_guess(std::int16_t distance) { return (distance & 1) != 0; }
  static constexpr double step_voxels = truncation_voxels / farthest;

  std::size_t first_block = 0;          // the blocks before are not (or no longer) there
  std::vector<std::int16_t> distances;  // block_voxels for each block

  [[nodiscard]] std::size_t end_block() const {
    return first_block + distances.size() / VoxelLattice::block_voxels;
  }
  [[nodiscard]] std::span<const std::int16_t> of_block(std::size_t block) const {
    return {distances.data() + (block - first_block) * VoxelLattice::block_voxels,
            VoxelLattice::block_voxels};
  }
  void forget_before(std::size_t block);
};

/// Curless and Levoy 1996: per voxel the weighted mean of its distances from the scans' surfaces. Each is the
/// distance along the line of sight times the cosine of the incidence, which is that from the tangent plane,
/// from the scan's depth map, truncated at 3 voxels; the weight falls to 0 over the rear half behind
/// a surface. What lies behind one surface but nearer to another of the opposite normal is no evidence
/// against that one: the two sides of a thin sheet do not cancel. Nor is it evidence, with less weight, where
/// another scan saw through: beside an edge a steep surface's rear reaches out of the object.
/// The blocks from the field's end to `end` are added to it.
void fuse_blocks(FusedField& field, const FusionBlocks& blocks, std::span<const DepthMap> maps,
                 std::size_t end);

/// The part that a depth map has in a voxel's value.
struct Sighting {
  float distance = 0;        // in voxels
  float weight = 0;          // 0: it has none
  bool seems_empty = false;  // of weight 0, but in front of the surface or of where it would go on
  float seen_through = 0;    // weight of the surface that was seen behind the place, more than the truncation
  Eigen::Vector4f pixel = Eigen::Vector4f::Zero();
};

/// How one depth map sees the places of one block: homogeneous picture coordinates, linear in the voxel.
class BlockSight {
 public:
  BlockSight(const DepthMap& map, const VoxelLattice& lattice, const Eigen::Vector3i& corner);

  /// column, row, depth of a place in voxels from the block's corner; a column beyond every picture where it
  /// lies behind the scanner.
  [[nodiscard]] Eigen::Vector3f picture_of(const Eigen::Vector3f& in_block) const {
    const Eigen::Vector3f p = picture_from_block_ * in_block + at_corner_;
    if (map_->sight.parallel) return p;
    if (!(p.z() > 0)) return {-1, -1, 0};
    return {p.x() / p.z(), p.y() / p.z(), p.z()};
  }
  [[nodiscard]] Sighting sighting(const Eigen::Vector3f& in_block) const;
  /// Of what it saw, unit length, in the world.
  [[nodiscard]] Eigen::Vector3f normal(const Eigen::Vector3f& in_block, const Eigen::Vector4f& pixel) const;
  [[nodiscard]] const DepthMap& map() const { return *map_; }

 private:
  [[nodiscard]] bool is_far(const Eigen::Vector4f& pixel, float depth) const;

  const DepthMap* map_;
  Eigen::Matrix3f picture_from_block_;
  Eigen::Vector3f at_corner_;
  Eigen::Matrix3f world_from_sight_;
  float voxels_per_length_;
};

/// The distances of one place from all surfaces that count there, and their weights, in the maps' order; what
/// an opposite surface shields has weight 0.
void shield_opposite_sides(std::span<Sighting> sightings, std::span<const BlockSight> sights,
                           const Eigen::Vector3f& in_block);

}  // namespace drape::meshing
