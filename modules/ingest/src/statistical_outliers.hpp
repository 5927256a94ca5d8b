// Points that lie unusually far from their neighbours.
#pragma once

#include <cstdint>
#include <vector>

namespace drape::ingest {

/// Flags of the points whose mean neighbour distance exceeds mean + sigmas * standard deviation over all
/// points (Rusu et al. 2008, "Towards 3D point cloud based object maps", section 4.1), but never of those
/// within twice the mean: that is where the border of a clean, even scan lies.
[[nodiscard]] std::vector<std::uint8_t> statistical_outliers(const std::vector<double>& mean_distances,
                                                             double sigmas);

}  // namespace drape::ingest
