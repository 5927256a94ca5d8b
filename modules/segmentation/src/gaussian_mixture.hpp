// Clusters by a mixture of Gaussians over colour, texture and position.
#pragma once

#include <optional>

#include "lab_image.hpp"

namespace drape::segmentation {

/// Per pixel the component 0..k-1 that explains it best: expectation-maximisation (Dempster, Laird, Rubin
/// 1977, by OpenCV, diagonal covariances) over eight features: smoothed L, a, b, the three of
/// texture_features, x and y. Without `clusters`, the number of 2..8 with the least description length
/// (Rissanen 1978), as Carson et al. (PAMI 2002) choose it.
[[nodiscard]] Labels mixture_clusters(const ImageF& lab, std::optional<int> clusters, double position_weight,
                                      std::uint64_t seed);

}  // namespace drape::segmentation
