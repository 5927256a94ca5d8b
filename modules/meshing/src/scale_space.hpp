// Surface reconstruction at a coarser scale.
#pragma once

#include "drape/geometry/point_cloud.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

/// A mesh whose vertices are the samples (not all of them need have a face); pieces may be inside out. It is
/// found by an advancing front on samples that were smoothed four times by weighted principal components
/// within `radius`, and so takes noise for noise; the samples keep their places. Digne, Morel, Souzani and
/// Lartigue 2011, by CGAL. No triangle has an edge longer than `longest_edge` at the smoothed scale.
[[nodiscard]] TriangleMesh scale_space_mesh(const PointCloud& samples, double radius, double longest_edge);

}  // namespace drape::meshing
