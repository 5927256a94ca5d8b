// Cutting away surface that no sample supports.
#pragma once

#include "cleaning.hpp"
#include "drape/geometry/point_cloud.hpp"

namespace drape::meshing {

/// Without faces that have a vertex, or along a long edge or in the middle a point, farther than `distance`
/// from every sample; then without the teeth that this leaves on the border. `removed` counts faces.
[[nodiscard]] Cleaned trimmed_to_samples(const TriangleMesh& mesh, const PointCloud& samples,
                                         double distance);

}  // namespace drape::meshing
