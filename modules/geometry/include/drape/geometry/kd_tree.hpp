// Nearest neighbours of points in space.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace drape {

struct Neighbor {
  std::uint32_t index;
  double squared_distance;
};

/// A static k-d tree (nanoflann). The points are referred to, not copied: they must outlive the tree and stay
/// put. Queries may run on several threads at once.
class KdTree {
 public:
  explicit KdTree(std::span<const Eigen::Vector3d> points);
  ~KdTree();
  KdTree(KdTree&&) noexcept;
  KdTree& operator=(KdTree&&) noexcept;

  /// Nearest first; at most `count`, fewer if there are not so many points.
  [[nodiscard]] std::vector<Neighbor> nearest(const Eigen::Vector3d& query, std::size_t count) const;
  /// The same into a buffer of the caller's, for inner loops; returns how many were found.
  std::size_t nearest(const Eigen::Vector3d& query, std::span<Neighbor> found) const;
  /// The nearest one closer than `radius`, for inner loops: it looks no further than that.
  [[nodiscard]] std::optional<Neighbor> nearest_within(const Eigen::Vector3d& query, double radius) const;
  /// All within `radius`, nearest first.
  [[nodiscard]] std::vector<Neighbor> within(const Eigen::Vector3d& query, double radius) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace drape
