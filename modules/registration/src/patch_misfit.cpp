#include "patch_misfit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace drape::registration {
namespace {

constexpr double patch_radius_voxels = 2.5;
constexpr double reach_voxels = 1.5;
constexpr int least_points = 20;
constexpr double least_noise_voxels = 0.1;  // from there on coarse scans are smoothed
constexpr std::size_t most_points = 16000;

struct Sum {
  double distance = 0;
  int count = 0;
};

// Of the patches round the points of `coarse`, of which `surface` has the single points.
void add_patches(const ScanSurface& surface, const CoarseScan& coarse, const ScanSurface& other,
                 const Rigid3& other_from_surface, double noise, std::vector<double>& deviations) {
  std::vector<Sum> sums(coarse.size());
  for (const std::uint32_t i : surface.sample(most_points)) {
    const auto home = coarse.nearest(surface.points()[i]);
    if (!home) continue;
    const auto match =
        other.match(other_from_surface * surface.points()[i],
                    other_from_surface.linear() * surface.normals()[i], reach_voxels * coarse.voxel());
    if (!match) continue;
    sums[*home].distance += match->distance;
    sums[*home].count += 1;
  }
  const NeighborLists& neighbors = coarse.neighbors();
  const auto radius = static_cast<float>(patch_radius_voxels * coarse.voxel());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    Sum patch = sums[i];
    for (std::uint32_t k = neighbors.begin[i]; k < neighbors.begin[i + 1]; ++k) {
      if (!(neighbors.distance[k] < radius)) continue;
      patch.distance += sums[neighbors.index[k]].distance;
      patch.count += sums[neighbors.index[k]].count;
    }
    if (patch.count >= least_points)
      deviations.push_back(std::abs(patch.distance) / (std::sqrt(patch.count) * noise));
  }
}

}  // namespace

double patch_misfit(const ScanSurface& source, const CoarseScan& coarse_source, const ScanSurface& target,
                    const CoarseScan& coarse_target, const Rigid3& target_from_source) {
  const double noise = std::max(coarse_source.noise(), coarse_target.noise());
  if (!(noise > least_noise_voxels * coarse_source.voxel())) return 0;
  std::vector<double> deviations;
  add_patches(source, coarse_source, target, target_from_source, noise, deviations);
  add_patches(target, coarse_target, source, target_from_source.inverse(), noise, deviations);
  if (deviations.empty()) return 0;
  const auto upper = deviations.begin() + static_cast<std::ptrdiff_t>(3 * deviations.size() / 4);
  std::nth_element(deviations.begin(), upper, deviations.end());
  return *upper;
}

}  // namespace drape::registration
