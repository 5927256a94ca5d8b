// What the surface round a point looks like, whatever way it is turned.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "coarse_scan.hpp"

namespace drape::registration {

using Features = Eigen::Matrix<float, 33, Eigen::Dynamic>;

/// Fast point feature histograms (Rusu, Blodow and Beetz 2009), one column a point of the scan: 11 bins each
/// of the three angles between oriented points, over the neighbours within CoarseScan::feature_radius_voxels.
/// Columns hold square roots and have unit length, so that their inner product is the Bhattacharyya
/// coefficient of two histograms; that of a point without neighbours is zero.
[[nodiscard]] Features point_features(const CoarseScan& scan);

/// Points of two scans whose surroundings look alike.
struct FeatureMatch {
  std::uint32_t source;
  std::uint32_t target;
  float similarity;  // inner product of the features
  bool mutual;       // each is the other's most similar point
};

/// For each point of either scan the most similar one of the other scan: mutual ones first, then by
/// similarity, at most `most`.
[[nodiscard]] std::vector<FeatureMatch> match_features(const Features& source, const Features& target,
                                                       std::size_t most);

}  // namespace drape::registration
