// Divisive and agglomerative clustering of colour and position.
#pragma once

#include <optional>

#include "lab_image.hpp"

namespace drape::segmentation {

/// Per pixel its cluster 0..k-1. Starts with all superpixels in one cluster and splits, again and again, the
/// cluster whose two halves are the farthest apart (thesis, Algorithm 1). Halves are found by 2-means from
/// the cluster's longest axis; "apart" is Ward's distance n1 n2 / (n1 + n2) |m1 - m2|^2 (Ward 1963), by which
/// a split lessens the squared error. Without `clusters`, until 95 % of the variance is explained, or 16.
[[nodiscard]] Labels divisive_clusters(const ImageF& lab, std::optional<int> clusters,
                                       double position_weight);

/// The same from below: every superpixel is a cluster, and the two that are the closest by Ward's distance
/// become one (thesis, Algorithm 2), wherever they lie.
[[nodiscard]] Labels agglomerative_clusters(const ImageF& lab, std::optional<int> clusters,
                                            double position_weight);

}  // namespace drape::segmentation
