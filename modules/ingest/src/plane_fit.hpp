// The plane of least squares through a few points.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace drape::ingest {

/// Sums over points, given relative to a place nearby. They are floats, and summed several at a time: points
/// wait until there are many.
class PlaneFit {
 public:
  void add(const Eigen::Vector3d& p) {
    if (waiting_count_ == most_waiting) take_waiting();
    const Eigen::Vector3f place = p.cast<float>();
    for (std::size_t axis = 0; axis < 3; ++axis)
      waiting_[axis][waiting_count_] = place[static_cast<Eigen::Index>(axis)];
    ++waiting_count_;
  }

  /// Unit normal by total least squares (the covariance's least axis); its sign is arbitrary. Points that do
  /// not span a plane get some direction across their line, or z.
  [[nodiscard]] Eigen::Vector3f normal();

 private:
  static constexpr std::size_t most_waiting = 32;

  void take_waiting();

  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d products_ = Eigen::Vector3d::Zero();  // yz, zx, xy
  double count_ = 0;
  std::array<std::array<float, most_waiting>, 3> waiting_;  // the first waiting_count_ of each axis
  std::size_t waiting_count_ = 0;
};

}  // namespace drape::ingest
