#include "coarse_scan.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace drape::registration {
namespace {

constexpr double plane_radius_voxels = 3;
constexpr double noisy_voxels = 0.1;
constexpr int nearest_reach = 2;  // voxels to each side

std::size_t occupied_voxels(const ScanSurface& surface, double voxel) {
  VoxelTable table(surface.box().min(), voxel);
  std::uint32_t count = 0;
  for (const auto& p : surface.points())
    if (table.find_or_add(table.voxel_of(p), count) == count) ++count;
  return count;
}

}  // namespace

CoarseScan::CoarseScan(const ScanSurface& surface, double voxel)
    : voxel_(voxel), noise_(surface.noise()), nearest_(surface.box().min(), voxel) {
  average(surface);
  fill_nearest();
}

void CoarseScan::average(const ScanSurface& surface) {
  VoxelTable table(surface.box().min(), voxel_);
  std::vector<Eigen::Vector3d> sides;
  std::vector<double> counts;
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const auto next = static_cast<std::uint32_t>(points_.size());
    const std::uint32_t number = table.find_or_add(table.voxel_of(surface.points()[i]), next);
    if (number == next) {
      points_.emplace_back(Eigen::Vector3d::Zero());
      sides.emplace_back(Eigen::Vector3d::Zero());
      counts.push_back(0);
    }
    points_[number] += surface.points()[i];
    sides[number] += surface.normals()[i];
    counts[number] += 1;
  }
  for (std::size_t i = 0; i < points_.size(); ++i) points_[i] /= counts[i];
  find_neighbors();
  fit_planes(sides, counts, surface.noise() > noisy_voxels * voxel_);
}

void CoarseScan::find_neighbors() {
  // Points by the cell they lie in, cells as large as the radius: neighbours lie in the 27 cells around.
  const double radius = feature_radius_voxels * voxel_;
  BoundingBox box;
  for (const auto& p : points_) box.extend(p);
  VoxelTable cells(box.min(), radius);
  std::vector<std::vector<std::uint32_t>> members;
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    const auto next = static_cast<std::uint32_t>(members.size());
    const std::uint32_t cell = cells.find_or_add(cells.voxel_of(points_[i]), next);
    if (cell == next) members.emplace_back();
    members[cell].push_back(i);
  }
  neighbors_.begin.push_back(0);
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    const Eigen::Vector3i home = cells.voxel_of(points_[i]);
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const std::uint32_t* cell = cells.find(home + Eigen::Vector3i(x, y, z));
          if (cell == nullptr) continue;
          for (const std::uint32_t j : members[*cell]) {
            const double squared = (points_[j] - points_[i]).squaredNorm();
            if (j == i || squared > radius * radius) continue;
            neighbors_.index.push_back(j);
            neighbors_.distance.push_back(static_cast<float>(std::sqrt(squared)));
          }
        }
    neighbors_.begin.push_back(static_cast<std::uint32_t>(neighbors_.index.size()));
  }
}

// A voxel cuts the noise of a surface that passes near its wall in two, each half with its own mean: moving
// the means onto planes through their neighbourhoods (moving least squares, Alexa et al. 2003) joins them
// again. Where there is little noise it would only round the shape off.
void CoarseScan::fit_planes(const std::vector<Eigen::Vector3d>& sides, const std::vector<double>& counts,
                            bool smooth) {
  const double radius = plane_radius_voxels * voxel_;
  std::vector<Eigen::Vector3d> on_planes = points_;
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    double weights = counts[i];
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    int count = 1;
    for (std::uint32_t k = neighbors_.begin[i]; k < neighbors_.begin[i + 1]; ++k) {
      const double nearness = 1 - std::pow(static_cast<double>(neighbors_.distance[k]) / radius, 2);
      if (!(nearness > 0)) continue;
      const double weight = nearness * nearness * counts[neighbors_.index[k]];
      const Eigen::Vector3d step = points_[neighbors_.index[k]] - points_[i];
      sum += weight * step;
      squares += weight * step * step.transpose();
      weights += weight;
      ++count;
    }
    Eigen::Vector3d normal = sides[i];
    if (count >= 4) {
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
      solver.computeDirect(squares / weights - sum * sum.transpose() / (weights * weights));
      normal = solver.eigenvectors().col(0);
      if (normal.dot(sides[i]) < 0) normal = -normal;
      if (smooth) on_planes[i] += normal * normal.dot(sum / weights);
    }
    normals_.push_back(normal.norm() > 0 ? normal.normalized() : Eigen::Vector3d::UnitZ());
  }
  points_ = std::move(on_planes);
}

void CoarseScan::fill_nearest() {
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    const Eigen::Vector3i home = nearest_.voxel_of(points_[i]);
    for (int x = -nearest_reach; x <= nearest_reach; ++x)
      for (int y = -nearest_reach; y <= nearest_reach; ++y)
        for (int z = -nearest_reach; z <= nearest_reach; ++z) {
          const Eigen::Vector3i voxel = home + Eigen::Vector3i(x, y, z);
          const Eigen::Vector3d middle = nearest_.middle_of(voxel);
          std::uint32_t& nearest = nearest_.find_or_add(voxel, i);
          if ((points_[i] - middle).squaredNorm() < (points_[nearest] - middle).squaredNorm()) nearest = i;
        }
  }
}

double coarse_voxel(std::span<const ScanSurface> surfaces, std::size_t points) {
  std::vector<double> voxels;
  for (const ScanSurface& surface : surfaces) {
    if (!surface.is_surface()) continue;
    // The number of voxels that a surface passes falls with the square of their size.
    double voxel = surface.box().diagonal().norm() / std::sqrt(static_cast<double>(points));
    for (int round = 0; round < 3; ++round)
      voxel *= std::sqrt(static_cast<double>(occupied_voxels(surface, voxel)) / static_cast<double>(points));
    voxels.push_back(std::max(voxel, surface.spacing()));
  }
  if (voxels.empty()) return 0;
  const auto middle = voxels.begin() + static_cast<std::ptrdiff_t>(voxels.size() / 2);
  std::nth_element(voxels.begin(), middle, voxels.end());
  return *middle;
}

}  // namespace drape::registration
