// The silhouette method beside published ones.
#pragma once

#include <nlohmann/json.hpp>

namespace drape::lab {

/// `photos` simulated photos of each of some models. All methods start from the same candidates: the most
/// different of the best rotations of a first pass by 45 degrees (alignment::Method::exhaustive without its
/// refinement), and each method's answer is the one of them that it ends up liking best. The silhouette
/// method is shown without any candidates as well.
[[nodiscard]] nlohmann::json print_peer_table(int photos);

/// From a mesh in memory to the pose, for meshes of under 15,000 and of about 100,000 triangles: the
/// process's first call on that mesh, and the median of later ones. CPU seconds.
[[nodiscard]] nlohmann::json print_times(int photos);

}  // namespace drape::lab
