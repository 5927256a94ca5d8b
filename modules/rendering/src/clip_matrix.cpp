#include "clip_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drape::rendering {
namespace {

constexpr double margin = 1e-3;  // of the depth range, at both ends
constexpr double least_near_to_far = 1e-4;

}  // namespace

std::optional<DepthRange> depth_range(const Camera& camera, const BoundingBox& box) {
  if (box.isEmpty()) return std::nullopt;
  double nearest = std::numeric_limits<double>::infinity();
  double farthest = -nearest;
  for (int i = 0; i < 8; ++i) {
    const double depth = (camera.camera_from_world * box.corner(static_cast<BoundingBox::CornerType>(i))).z();
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  // A flat mesh seen head-on has no range of its own: rounding must not cut it away.
  const double slack = margin * (farthest - nearest) +
                       1e-6 * std::max(std::abs(nearest), std::abs(farthest)) +
                       std::numeric_limits<double>::min();
  nearest -= slack;
  farthest += slack;
  if (camera.projection == Camera::Projection::perspective) {
    if (farthest <= 2 * slack) return std::nullopt;
    nearest = std::max(nearest, least_near_to_far * farthest);
  }
  return DepthRange{nearest, farthest};
}

Eigen::Matrix4d clip_from_world(const Camera& camera, const Window& window, const DepthRange& range) {
  // Pixel coordinates of the frame buffer instead of the image's.
  Eigen::Matrix3d window_from_image = Eigen::Matrix3d::Identity();
  window_from_image(0, 0) = window_from_image(1, 1) = window.samples;
  window_from_image(0, 2) = -window.x * window.samples;
  window_from_image(1, 2) = -window.y * window.samples;
  const Eigen::Matrix3d K = window_from_image * camera.K;
  const double width = static_cast<double>(window.width) * window.samples;
  const double height = static_cast<double>(window.height) * window.samples;
  const double span = range.farthest - range.nearest;

  Eigen::Matrix4d clip = Eigen::Matrix4d::Zero();
  if (camera.projection == Camera::Projection::perspective) {
    // u = (K x).x / z, and OpenGL shows x_clip / w at u = (x_clip / w + 1) width / 2: so w = z.
    clip.block<1, 3>(0, 0) = 2 / width * K.row(0) - Eigen::RowVector3d::UnitZ();
    clip.block<1, 3>(1, 0) = 2 / height * K.row(1) - Eigen::RowVector3d::UnitZ();
    clip(2, 2) = -range.nearest / span;
    clip(2, 3) = range.nearest * range.farthest / span;
    clip(3, 2) = 1;
  } else {
    clip.block<1, 2>(0, 0) = 2 / width * K.block<1, 2>(0, 0);
    clip(0, 3) = 2 / width * K(0, 2) - 1;
    clip.block<1, 2>(1, 0) = 2 / height * K.block<1, 2>(1, 0);
    clip(1, 3) = 2 / height * K(1, 2) - 1;
    clip(2, 2) = -1 / span;
    clip(2, 3) = range.farthest / span;
    clip(3, 3) = 1;
  }
  return clip * camera.camera_from_world.matrix();
}

}  // namespace drape::rendering
