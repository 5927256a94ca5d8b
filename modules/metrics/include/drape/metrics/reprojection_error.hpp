// How far apart two cameras put the same points in the photo.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "drape/geometry/camera.hpp"
#include "drape/metrics/distribution.hpp"

namespace drape::metrics {

struct ReprojectionError {
  Distribution distance_px;      // at the true camera's image size
  std::size_t behind_found = 0;  // points that only the true camera has in front of it: not in distance_px
};

/// Of the points (a mesh's vertices) that lie in front of the true camera; hidden ones and those outside the
/// picture count too. Error{input} for a camera without pixels, or when no point lies in front of the true
/// camera.
[[nodiscard]] ReprojectionError reprojection_error(std::span<const Eigen::Vector3d> points,
                                                   const Camera& found, const Camera& truth);

}  // namespace drape::metrics
