#include "field_smoothing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "drape/base/parallel.hpp"

namespace drape::meshing {
namespace {

constexpr int block = VoxelLattice::block;
constexpr int most_steps = 2;
constexpr int widest = block + 2 * most_steps;
// Farther from the surface than this, in voxels, no cube has a part of it, nor has the next voxel that a
// second step asks; and beyond the truncation distances are none.
constexpr float near_surface = 2;

bool is_near(std::int16_t distance) {
  constexpr int most = static_cast<int>(static_cast<double>(near_surface) / FusedField::step_voxels);
  return distance != FusedField::unknown && !FusedField::is_guess(distance) && std::abs(distance) <= most;
}

// The voxels of a block and of a margin round it: distances in voxels, not a number where there is no
// evidence.
class Surroundings {
 public:
  Surroundings(const FusedField& field, const FusionBlocks& blocks, std::size_t center, int margin)
      : margin_(margin), side_(block + 2 * margin) {
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
          const std::uint64_t key =
              blocks.keys[center] + static_cast<std::uint64_t>((std::int64_t{z} << (2 * BlockKey::bits)) +
                                                               (std::int64_t{y} << BlockKey::bits) + x);
          const std::uint32_t at =
              x == 0 && y == 0 && z == 0 ? static_cast<std::uint32_t>(center) : blocks.find(key);
          const bool there = at != FusionBlocks::none && at >= field.first_block && at < field.end_block();
          copy(there ? field.of_block(at).data() : nullptr, {x, y, z});
        }
  }

  [[nodiscard]] float value(int x, int y, int z) const { return values_[place(x, y, z)]; }

  /// One step, of the block and `reach` voxels round it.
  void smooth(int reach, float share) {
    const std::array<float, widest* widest* widest> before = values_;
    const Directions directions = directions_of(side_);
    for (int z = -reach; z < block + reach; ++z)
      for (int y = -reach; y < block + reach; ++y)
        for (int x = -reach; x < block + reach; ++x) {
          const std::size_t here = place(x, y, z);
          if (std::abs(before[here]) <= near_surface)
            values_[here] += share * shift_of(&before[here], directions);
        }
  }

 private:
  static constexpr std::size_t pairs = 13;
  struct Directions {
    std::array<std::ptrdiff_t, pairs> step{};  // from a voxel to the next one
    std::array<float, pairs> per_limit{};      // 1 / the second difference that has no weight
  };

  // Half of the 26 voxels round one; the other half lies opposite. The surface bends at a crease by as much
  // as it is far to the next voxel; noise bends it by less.
  static Directions directions_of(int side) {
    Directions directions;
    std::size_t k = 0;
    for (int z = 0; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
          if (z * 9 + y * 3 + x <= 0) continue;
          directions.step[k] = (z * side + y) * side + x;
          directions.per_limit[k++] = 1 / std::sqrt(static_cast<float>(x * x + y * y + z * z));
        }
    return directions;
  }

  // The weights add up to 26 / 27 at most: as much as of the mean over 3 x 3 x 3 voxels.
  static float shift_of(const float* here, const Directions& directions) {
    float shift = 0;
    for (std::size_t k = 0; k < pairs; ++k) {
      const std::ptrdiff_t step = directions.step[k];
      const float bend = (here[step] + here[-step]) / 2 - *here;
      const float r = bend * directions.per_limit[k];
      const float w = 1 - r * r;
      if (w > 0) shift += w * w * bend;  // not where one is not a number
    }
    return shift * (2.0F / 27);
  }

  [[nodiscard]] std::size_t place(int x, int y, int z) const {
    return static_cast<std::size_t>(((z + margin_) * side_ + y + margin_) * side_ + x + margin_);
  }
  static float value_of(std::int16_t d) {
    return d == FusedField::unknown || FusedField::is_guess(d)
               ? std::numeric_limits<float>::quiet_NaN()
               : static_cast<float>(d) * static_cast<float>(FusedField::step_voxels);
  }
  // The part of a neighbouring block, at `at` blocks from this one, that lies in the margin.
  void copy(const std::int16_t* from, const Eigen::Vector3i& at) {
    const Eigen::Array3i first = (at.array() * block).max(-margin_);
    const Eigen::Array3i end = ((at.array() + 1) * block).min(block + margin_);
    for (int z = first.z(); z < end.z(); ++z)
      for (int y = first.y(); y < end.y(); ++y)
        for (int x = first.x(); x < end.x(); ++x) {
          const int there = ((z - at.z() * block) * block + y - at.y() * block) * block + x - at.x() * block;
          values_[place(x, y, z)] =
              from == nullptr ? std::numeric_limits<float>::quiet_NaN() : value_of(from[there]);
        }
  }

  int margin_;
  int side_;
  std::array<float, widest * widest * widest> values_{};
};

std::int16_t quantized(float voxels) {
  constexpr auto most = static_cast<float>(FusedField::farthest);
  const float steps = std::clamp(voxels / static_cast<float>(FusedField::step_voxels), -most, most);
  return static_cast<std::int16_t>(2 * std::lround(steps / 2));
}

void smooth_block(const FusedField& raw, const FusionBlocks& blocks, std::size_t b,
                  std::span<const float> steps, std::int16_t* to) {
  const auto from = raw.of_block(b);
  std::copy(from.begin(), from.end(), to);
  if (std::none_of(from.begin(), from.end(), is_near)) return;
  int margin = static_cast<int>(steps.size());
  Surroundings surroundings(raw, blocks, b, margin);
  for (const float share : steps) surroundings.smooth(--margin, share);
  for (int z = 0; z < block; ++z)
    for (int y = 0; y < block; ++y)
      for (int x = 0; x < block; ++x, ++to)
        if (is_near(*to)) *to = quantized(surroundings.value(x, y, z));
}

}  // namespace

std::span<const float> smoothing_steps(double noise_voxels) {
  // Of simulated scans of five shapes the normals gain, and the distances do not lose.
  constexpr double some = 0.4;
  constexpr double heavy = 0.8;
  static constexpr std::array<float, 2> there_and_back = {1, -0.9F};
  static constexpr std::array<float, 2> twice = {1, 1};
  if (noise_voxels >= heavy) return twice;
  if (noise_voxels >= some) return there_and_back;
  return {};
}

void smooth_blocks(FusedField& smooth, const FusedField& raw, const FusionBlocks& blocks,
                   std::span<const float> steps, std::size_t end) {
  const std::size_t begin = smooth.end_block();
  smooth.distances.resize((end - smooth.first_block) * VoxelLattice::block_voxels);
  parallel_for(end - begin, 64, [&](std::size_t from, std::size_t to) {
    for (std::size_t b = begin + from; b < begin + to; ++b)
      smooth_block(raw, blocks, b, steps,
                   &smooth.distances[(b - smooth.first_block) * VoxelLattice::block_voxels]);
  });
}

}  // namespace drape::meshing
