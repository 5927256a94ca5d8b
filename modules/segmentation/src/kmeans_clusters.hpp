// K-means clusters of colour and position.
#pragma once

#include <optional>

#include "lab_image.hpp"

namespace drape::segmentation {

/// Per pixel the cluster 0..k-1 it belongs to. Never more clusters than distinct pixels. Without `clusters`,
/// the fewest of 2..16 that explain `explained_share` of the features' variance.
[[nodiscard]] Labels kmeans_clusters(const ImageF& lab, std::optional<int> clusters, double position_weight,
                                     std::uint64_t seed);

}  // namespace drape::segmentation
