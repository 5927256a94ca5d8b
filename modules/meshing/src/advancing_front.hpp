// Surface reconstruction by an advancing front.
#pragma once

#include "drape/geometry/point_cloud.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

/// A mesh whose vertices are the samples (not all of them need have a face); pieces may be inside out. No
/// triangle has an edge longer than `longest_edge`. Cohen-Steiner and Da 2004, by CGAL.
[[nodiscard]] TriangleMesh advancing_front_mesh(const PointCloud& samples, double longest_edge);

}  // namespace drape::meshing
