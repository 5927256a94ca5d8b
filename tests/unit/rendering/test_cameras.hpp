// Cameras and outlines that several tests of rendering share.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "drape/geometry/camera.hpp"

namespace drape::rendering {

/// A camera somewhere round the origin, about `distance` away, that sees a body of radius 1 in the middle of
/// its image: different focal lengths, shear, principal point off the centre.
[[nodiscard]] Camera random_camera(std::uint64_t seed, Camera::Projection projection, double distance = 5,
                                   int width = 310, int height = 230);

/// Distance in pixels of a pixel position to the convex hull of points: negative inside.
[[nodiscard]] double distance_to_hull(const std::vector<Eigen::Vector2d>& points,
                                      const Eigen::Vector2d& pixel);

}  // namespace drape::rendering
