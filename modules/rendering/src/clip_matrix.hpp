// From a drape camera to OpenGL's clip space.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "drape/geometry/bounding_box.hpp"
#include "drape/geometry/camera.hpp"

namespace drape::rendering {

/// The part of the camera's image that one frame buffer shows, each pixel divided into samples x samples.
struct Window {
  int x = 0;
  int y = 0;
  int width = 0;  // in pixels of the camera
  int height = 0;
  int samples = 1;

  [[nodiscard]] std::size_t sample_count() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
           static_cast<std::size_t>(samples) * static_cast<std::size_t>(samples);
  }
};

/// Depths along the optical axis between which the mesh lies, as far as it is in front of the camera.
struct DepthRange {
  double nearest;
  double farthest;
};

/// Of everything in `box`; none if it is empty or nothing of it is in front of a perspective camera. The
/// nearest depth of a perspective camera that stands within the box is a ten-thousandth of the farthest: what
/// is nearer is not drawn.
[[nodiscard]] std::optional<DepthRange> depth_range(const Camera& camera, const BoundingBox& box);

/// clip = clip_from_world * (X, 1). The frame buffer's row 0 is the image's row 0 (y is not turned round), so
/// that pictures need no flipping. Depth is reversed, 1 at the nearest and 0 at the farthest, for clip
/// control 0..1 and a floating-point depth plane: that keeps the resolution even over any range of depths.
[[nodiscard]] Eigen::Matrix4d clip_from_world(const Camera& camera, const Window& window,
                                              const DepthRange& range);

}  // namespace drape::rendering
