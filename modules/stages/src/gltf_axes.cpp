#include "gltf_axes.hpp"

namespace drape::stages {

Eigen::Matrix3d y_up_from(char up) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  if (up == 'z') rotation << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  if (up == 'x') rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  return rotation;
}

}  // namespace drape::stages
