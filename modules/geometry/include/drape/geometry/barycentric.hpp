// Places on a face by its corners.
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape {

/// Barycentric coordinates of a point in a face's plane (of a point off it: of its foot): how much each
/// corner counts there. They add up to 1 and are negative beyond the opposite edge; a third each for a face
/// without area.
[[nodiscard]] Eigen::Vector3d barycentric_weights(const TriangleMesh& mesh, std::size_t face,
                                                  const Eigen::Vector3d& point);

}  // namespace drape
