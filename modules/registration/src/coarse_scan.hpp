// A scan with few, smoothed points: what a first guess is sought and judged on.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scan_surface.hpp"
#include "voxel_table.hpp"

namespace drape::registration {

/// For each point the others within a radius; those of point i lie from begin[i] to begin[i + 1].
struct NeighborLists {
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> index;
  std::vector<float> distance;
};

/// One point for each occupied voxel.
class CoarseScan {
 public:
  CoarseScan(const ScanSurface& surface, double voxel);

  [[nodiscard]] double voxel() const { return voxel_; }
  /// Of the surface's own points.
  [[nodiscard]] double noise() const { return noise_; }
  [[nodiscard]] std::size_t size() const { return points_.size(); }
  /// Means of the surface's points in each voxel, smoothed where they are noisy, in the scan's frame.
  [[nodiscard]] const std::vector<Eigen::Vector3d>& points() const { return points_; }
  /// Of planes through the points within 3 voxels, on the side that the surface's own normals are.
  [[nodiscard]] const std::vector<Eigen::Vector3d>& normals() const { return normals_; }
  /// Within `feature_radius_voxels`.
  [[nodiscard]] const NeighborLists& neighbors() const { return neighbors_; }
  static constexpr double feature_radius_voxels = 5;

  /// The point nearest to (the middle of the voxel of) `query`, if there is one within two voxels or so: a
  /// look-up in a table.
  [[nodiscard]] std::optional<std::uint32_t> nearest(const Eigen::Vector3d& query) const {
    const std::uint32_t* found = nearest_.find(nearest_.voxel_of(query));
    return found != nullptr ? std::optional(*found) : std::nullopt;
  }

 private:
  void average(const ScanSurface& surface);
  void find_neighbors();
  void fit_planes(const std::vector<Eigen::Vector3d>& sides, const std::vector<double>& counts, bool smooth);
  void fill_nearest();

  double voxel_;
  double noise_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<Eigen::Vector3d> normals_;
  NeighborLists neighbors_;
  VoxelTable nearest_;
};

/// The voxel that leaves about `points` points of the median scan.
[[nodiscard]] double coarse_voxel(std::span<const ScanSurface> surfaces, std::size_t points);

}  // namespace drape::registration
