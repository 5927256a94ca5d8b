// Cameras all round an object.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "drape/geometry/camera.hpp"

namespace drape::report {

struct ViewStyle {
  int views = 6;
  int width_px = 480;
  int height_px = 480;
  double elevation_deg = 18;                        // of the cameras above the object's middle
  double filled_percent = 92;                       // of the picture, by the view that is the largest
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();    // in the points' frame
  Eigen::Vector3d front = Eigen::Vector3d::Zero();  // from the object to the first camera; zero: any side
};

/// Perspective cameras at equal angles round the `up` axis, counter-clockwise seen from above, all with the
/// same zoom, so that every point is in every picture. None without finite points. Error{input} for a style
/// that makes no pictures (sizes, up).
[[nodiscard]] std::vector<Camera> cameras_around(std::span<const Eigen::Vector3d> points,
                                                 const ViewStyle& style = {});

}  // namespace drape::report
