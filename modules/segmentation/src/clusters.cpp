#include "clusters.hpp"

#include "gaussian_mixture.hpp"
#include "hierarchical_clusters.hpp"
#include "kmeans_clusters.hpp"

namespace drape::segmentation {

Labels clusters_of(const ImageF& lab, const SegmentOptions& options, std::uint64_t seed) {
  switch (options.method) {
    case Method::divisive:
      return divisive_clusters(lab, options.clusters, options.position_weight);
    case Method::agglomerative:
      return agglomerative_clusters(lab, options.clusters, options.position_weight);
    case Method::em:
      return mixture_clusters(lab, options.clusters, options.position_weight, seed);
    default:
      return kmeans_clusters(lab, options.clusters, options.position_weight, seed);
  }
}

const char* clustering_name(Method method) {
  switch (method) {
    case Method::divisive:
      return "divisive";
    case Method::agglomerative:
      return "agglomerative";
    case Method::em:
      return "em";
    default:
      return "kmeans";
  }
}

}  // namespace drape::segmentation
