// Rigid motions. Names are frames: point_in_camera = camera_from_world * point_in_world.
#pragma once

#include <Eigen/Geometry>

namespace drape {

/// Rotation and translation. Constructing one from a matrix that is no rotation is the caller's mistake.
using Rigid3 = Eigen::Isometry3d;

}  // namespace drape
