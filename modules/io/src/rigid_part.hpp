// Poses as files round them.
#pragma once

#include "drape/geometry/rigid3.hpp"

namespace drape::io {

/// Whether a matrix is a rotation up to the rounding of a file.
[[nodiscard]] bool is_rotation(const Eigen::Matrix3d& matrix, double tolerance);

/// The rigid motion whose rotation is nearest to the matrix's upper left part.
[[nodiscard]] Rigid3 nearest_rigid(const Eigen::Matrix4d& matrix);

}  // namespace drape::io
