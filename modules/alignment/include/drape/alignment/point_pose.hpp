// A camera from places that a person showed on the model and in the photo.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "drape/geometry/camera.hpp"

namespace drape::alignment {

struct PointPair {
  Eigen::Vector2d pixel;  // of the photo
  Eigen::Vector3d point;  // in the mesh's frame
};

struct PointPose {
  Camera camera;
  double rms_px = 0;  // distance of the projected points from the pixels, root mean square
};

/// The camera with square pixels and its principal point in the middle that projects the points nearest to
/// the pixels, in the mesh's frame. `focal_px`: of the photo, held fixed; without it the focal length is
/// found too, and pulled towards that of an ordinary lens, which decides it where four pairs leave it open.
/// Levenberg-Marquardt (Marquardt 1963) from views all round, of which the best is taken: so it needs no
/// first guess, and planar points are no special case. Error{config} for fewer than four pairs, or points or
/// pixels (nearly) on one line.
[[nodiscard]] PointPose camera_from_points(const std::vector<PointPair>& pairs, int width, int height,
                                           std::optional<double> focal_px = std::nullopt);

}  // namespace drape::alignment
