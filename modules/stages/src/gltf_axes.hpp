// glTF is y up.
#pragma once

#include <Eigen/Core>

namespace drape::stages {

/// Turns the input's up axis ('x', 'y' or 'z') onto +y.
[[nodiscard]] Eigen::Matrix3d y_up_from(char up);

}  // namespace drape::stages
