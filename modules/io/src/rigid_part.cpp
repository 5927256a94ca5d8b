#include "rigid_part.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace drape::io {

bool is_rotation(const Eigen::Matrix3d& matrix, double tolerance) {
  return matrix.allFinite() && matrix.determinant() > 0 &&
         (matrix.transpose() * matrix - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < tolerance;
}

Rigid3 nearest_rigid(const Eigen::Matrix4d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix.topLeftCorner<3, 3>(),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Rigid3 motion = Rigid3::Identity();
  motion.linear() = svd.matrixU() * svd.matrixV().transpose();
  motion.translation() = matrix.topRightCorner<3, 1>();
  return motion;
}

}  // namespace drape::io
