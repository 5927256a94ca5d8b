// Points spread over a surface.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::metrics {

struct SurfaceSample {
  Eigen::Vector3d point;
  std::uint32_t face;
};

/// `count` points, uniform over the area; the same for the same seed. None on a mesh without area.
/// Error{input} if the mesh breaks its promises (see problem_of).
[[nodiscard]] std::vector<SurfaceSample> surface_samples(const TriangleMesh& mesh, std::size_t count,
                                                         std::uint64_t seed);

}  // namespace drape::metrics
