// A sparse grid: from voxels to numbers.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

namespace drape::registration {

/// Voxels of edge `voxel` from `corner` on, each with a number; open addressing, so that a look-up allocates
/// nothing and touches one or two cache lines.
class VoxelTable {
 public:
  VoxelTable(const Eigen::Vector3d& corner, double voxel)
      : corner_(corner), inverse_(1 / voxel), slots_(64, Slot{empty, 0}) {}

  /// The voxel that `point` lies in; nothing can be found more than a million voxels away.
  [[nodiscard]] Eigen::Vector3i voxel_of(const Eigen::Vector3d& point) const {
    return ((point - corner_) * inverse_).array().floor().cwiseMin(limit).cwiseMax(-limit).cast<int>();
  }
  [[nodiscard]] Eigen::Vector3d middle_of(const Eigen::Vector3i& voxel) const {
    return corner_ + (voxel.cast<double>().array() + 0.5).matrix() / inverse_;
  }

  /// The number of a voxel; null if it has none.
  [[nodiscard]] const std::uint32_t* find(const Eigen::Vector3i& voxel) const {
    const Slot& slot = slots_[slot_of(key_of(voxel))];
    return slot.key == empty ? nullptr : &slot.number;
  }
  /// The number of a voxel, `number` if it had none so far.
  std::uint32_t& find_or_add(const Eigen::Vector3i& voxel, std::uint32_t number) {
    const std::uint64_t key = key_of(voxel);
    std::size_t i = slot_of(key);
    if (slots_[i].key == empty) {
      if (2 * ++used_ > slots_.size()) {
        grow();
        i = slot_of(key);
      }
      slots_[i] = {key, number};
    }
    return slots_[i].number;
  }

 private:
  static constexpr double limit = (1 << 20) - 16;
  static constexpr std::uint64_t empty = ~std::uint64_t{0};
  struct Slot {
    std::uint64_t key;
    std::uint32_t number;
  };

  [[nodiscard]] static std::uint64_t key_of(const Eigen::Vector3i& voxel) {
    const auto axis = [](int v) { return static_cast<std::uint64_t>(v + (1 << 20)) & 0x1fffff; };
    return axis(voxel.x()) | axis(voxel.y()) << 21 | axis(voxel.z()) << 42;
  }
  /// Where the key is, or would be.
  [[nodiscard]] std::size_t slot_of(std::uint64_t key) const {
    const std::uint64_t hash = key * 0x9e3779b97f4a7c15ULL;
    std::size_t i = (hash ^ hash >> 32) & (slots_.size() - 1);
    while (slots_[i].key != key && slots_[i].key != empty) i = (i + 1) & (slots_.size() - 1);
    return i;
  }
  void grow() {
    std::vector<Slot> old(2 * slots_.size(), Slot{empty, 0});
    old.swap(slots_);
    for (const Slot& slot : old)
      if (slot.key != empty) slots_[slot_of(slot.key)] = slot;
  }

  Eigen::Vector3d corner_;
  double inverse_;
  std::vector<Slot> slots_;
  std::size_t used_ = 0;
};

}  // namespace drape::registration
