// Poses as files round them.
#pragma once

#include <Eigen/LU>
#include <Eigen/SVD>

#include "drape/geometry/rigid3.hpp"

namespace drape::io {

/// Whether a matrix is a rotation up to the rounding of a file.
[[nodiscard]] inline bool is_rotation(const Eigen::Matrix3d& matrix, double tolerance) {
  return matrix.allFinite() && matrix.determinant() > 0 &&
         (matrix.transpose() * matrix - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < tolerance;
}

/// The rigid motion whose rotation is nearest to the matrix's upper left part.
[[nodiscard]] inline Rigid3 nearest_rigid(const Eigen::Matrix4d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix.topLeftCorner<3, 3>(),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Rigid3 motion = Rigid3::Identity();
  motion.linear() = svd.matrixU() * svd.matrixV().transpose();
  motion.translation() = matrix.topRightCorner<3, 1>();
  return motion;
}

}  // namespace drape::io
