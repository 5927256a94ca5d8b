#include "fused_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "drape/base/parallel.hpp"

namespace drape::meshing {
namespace {

constexpr auto truncation = static_cast<float>(FusedField::truncation_voxels);

std::int16_t quantized(float distance_voxels, bool guess) {
  constexpr auto most = static_cast<float>(FusedField::farthest);
  const float steps = std::clamp(distance_voxels / static_cast<float>(FusedField::step_voxels), -most, most);
  const int even = 2 * static_cast<int>(std::lround(steps / 2));
  return static_cast<std::int16_t>(guess ? std::max(even - 1, 1) : even);
}

// The mean of what is evidence, else the least of what seems empty.
std::int16_t fused_distance(std::span<const Sighting> sightings) {
  float sum = 0;
  float weight = 0;
  float most_seen_through = 0;
  float least_empty = std::numeric_limits<float>::infinity();
  bool all_behind = true;
  for (const Sighting& s : sightings) {
    sum += s.weight * s.distance;
    weight += s.weight;
    if (s.weight > 0) all_behind &= s.distance < 0;
    most_seen_through = std::max(most_seen_through, s.seen_through);
    if (s.seems_empty) least_empty = std::min(least_empty, s.distance);
  }
  if (weight > 0 && !(all_behind && most_seen_through > weight)) return quantized(sum / weight, false);
  return std::isfinite(least_empty) ? quantized(least_empty, true) : FusedField::unknown;
}

std::vector<BlockSight> sights_on(const FusionBlocks& blocks, std::size_t block,
                                  std::span<const DepthMap> maps) {
  std::vector<BlockSight> sights;
  for (const std::uint32_t m : blocks.maps_of(block))
    sights.emplace_back(maps[m], blocks.lattice, blocks.corner(block));
  return sights;
}

void fuse_block(const std::vector<BlockSight>& sights, std::int16_t* distances) {
  std::vector<Sighting> sightings(sights.size());
  for (int z = 0; z < VoxelLattice::block; ++z)
    for (int y = 0; y < VoxelLattice::block; ++y)
      for (int x = 0; x < VoxelLattice::block; ++x, ++distances) {
        const Eigen::Vector3f at = Eigen::Vector3i(x, y, z).cast<float>();
        bool any_behind = false;
        for (std::size_t m = 0; m < sights.size(); ++m) {
          sightings[m] = sights[m].sighting(at);
          any_behind |= sightings[m].weight > 0 && sightings[m].distance < 0;
        }
        if (any_behind && sights.size() > 1) shield_opposite_sides(sightings, sights, at);
        *distances = fused_distance(sightings);
      }
}

}  // namespace

BlockSight::BlockSight(const DepthMap& map, const VoxelLattice& lattice, const Eigen::Vector3i& corner)
    : map_(&map), voxels_per_length_(static_cast<float>(1 / lattice.voxel)) {
  const Sight& sight = map.sight;
  const Eigen::Vector3d at = sight.sight_from_world * lattice.position(corner.cast<double>());
  const Eigen::Matrix3d across = lattice.voxel * sight.sight_from_world.linear();
  // column = (x / scale - corner.x) / pitch with scale 1 or z; times scale it is linear.
  Eigen::Matrix3d picture_from_sight = Eigen::Matrix3d::Identity();
  picture_from_sight(0, 0) = picture_from_sight(1, 1) = 1 / sight.pitch;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  if (sight.parallel)
    shift.head<2>() = -sight.corner / sight.pitch;
  else
    picture_from_sight.topRightCorner<2, 1>() = -sight.corner / sight.pitch;
  picture_from_block_ = (picture_from_sight * across).cast<float>();
  at_corner_ = (picture_from_sight * at + shift).cast<float>();
  world_from_sight_ = sight.sight_from_world.linear().transpose().cast<float>();
}

// Whether a place is farther from a pixel's surface than distances are told, without a look at how the
// surface runs from pixel to pixel: half of all places are.
bool BlockSight::is_far(const Eigen::Vector4f& pixel, float depth) const {
  // The longest that Sight::normal_of may be, where the sight looks 60 degrees off its axis at most, and how
  // much nearer the next pixel may be.
  const float steepness = std::abs(pixel[1]) + std::abs(pixel[2]);
  const float longest_normal = 1 + 2.8F * steepness;
  constexpr float voxels_between_pixels = 2;
  return std::abs(pixel[0] - depth) * voxels_per_length_ >
         truncation * longest_normal + voxels_between_pixels * steepness;
}

Sighting BlockSight::sighting(const Eigen::Vector3f& in_block) const {
  const Eigen::Vector3f picture = picture_of(in_block);
  Sighting sighting;
  const Eigen::Vector4f* const nearest = map_->nearest(picture.x(), picture.y());
  if (nearest == nullptr || (*nearest)[3] == 0) return sighting;
  if (is_far(*nearest, picture.z())) {
    sighting.pixel = *nearest;
    sighting.seems_empty = sighting.pixel[0] > picture.z();
    sighting.distance = sighting.seems_empty ? truncation : -truncation;
    if (sighting.seems_empty) sighting.seen_through = std::max(sighting.pixel[3], 0.0F);
    return sighting;
  }
  sighting.pixel = map_->at(picture.x(), picture.y());
  if (sighting.pixel[3] == 0) return sighting;
  const float along = (sighting.pixel[0] - picture.z()) * voxels_per_length_;
  sighting.distance =
      along / map_->sight.normal_of(picture.x(), picture.y(), sighting.pixel[1], sighting.pixel[2]).norm();
  if (!(sighting.pixel[3] > 0) || std::abs(sighting.distance) >= truncation) {
    sighting.seems_empty = sighting.distance > 0;
    if (sighting.distance > 0) sighting.seen_through = std::max(sighting.pixel[3], 0.0F);
    return sighting;
  }
  const float ramp = std::min(1.0F, 2 * (1 + sighting.distance / truncation));
  sighting.weight = sighting.pixel[3] * ramp;
  return sighting;
}

Eigen::Vector3f BlockSight::normal(const Eigen::Vector3f& in_block, const Eigen::Vector4f& pixel) const {
  const Eigen::Vector3f picture = picture_of(in_block);
  return world_from_sight_ * map_->sight.normal_of(picture.x(), picture.y(), pixel[1], pixel[2]).normalized();
}

void shield_opposite_sides(std::span<Sighting> sightings, std::span<const BlockSight> sights,
                           const Eigen::Vector3f& in_block) {
  // Weights are set to 0 only after all were compared: the outcome does not depend on the order.
  std::uint64_t shielded = 0;
  for (std::size_t i = 0; i < sightings.size() && i < 64; ++i) {
    const Sighting& behind = sightings[i];
    if (!(behind.weight > 0) || behind.distance >= 0) continue;
    const Eigen::Vector3f normal = sights[i].normal(in_block, behind.pixel);
    for (std::size_t j = 0; j < sightings.size(); ++j) {
      const Sighting& other = sightings[j];
      if (j == i || !(other.weight > 0) || std::abs(other.distance) >= -behind.distance) continue;
      if (normal.dot(sights[j].normal(in_block, other.pixel)) < 0) shielded |= std::uint64_t{1} << i;
    }
  }
  for (std::size_t i = 0; i < sightings.size() && i < 64; ++i)
    if ((shielded >> i) & 1) sightings[i].weight = 0;
}

void FusedField::forget_before(std::size_t block) {
  const auto gone = static_cast<std::ptrdiff_t>((block - first_block) * VoxelLattice::block_voxels);
  distances.erase(distances.begin(), distances.begin() + gone);
  first_block = block;
}

void fuse_blocks(FusedField& field, const FusionBlocks& blocks, std::span<const DepthMap> maps,
                 std::size_t end) {
  const std::size_t begin = field.end_block();
  field.distances.resize((end - field.first_block) * VoxelLattice::block_voxels);
  parallel_for(end - begin, 64, [&](std::size_t from, std::size_t to) {
    for (std::size_t b = begin + from; b < begin + to; ++b)
      fuse_block(sights_on(blocks, b, maps),
                 &field.distances[(b - field.first_block) * VoxelLattice::block_voxels]);
  });
}

}  // namespace drape::meshing
