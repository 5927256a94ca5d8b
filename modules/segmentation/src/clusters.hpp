// The ways to cluster pixels, one function for all.
#pragma once

#include "drape/segmentation/segment_photo.hpp"
#include "lab_image.hpp"

namespace drape::segmentation {

/// Without a number of clusters: the fewest that explain this share of the features' variance, and at most so
/// many.
inline constexpr double explained_share = 0.95;
inline constexpr int most_automatic_clusters = 16;

/// Per pixel the cluster 0..k-1 it belongs to, by options.method; methods that cluster nothing themselves
/// start from k-means. Never more clusters than distinct pixels.
[[nodiscard]] Labels clusters_of(const ImageF& lab, const SegmentOptions& options, std::uint64_t seed);

/// As its option is written: "kmeans", "divisive", "agglomerative", "em".
[[nodiscard]] const char* clustering_name(Method method);

}  // namespace drape::segmentation
