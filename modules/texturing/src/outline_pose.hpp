// Corrects a camera by the outline of what it sees.
#pragma once

#include <limits>
#include <optional>

#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"
#include "drape/geometry/triangle_mesh.hpp"
#include "drape/rendering/renderer.hpp"
#include "pose_step.hpp"

namespace drape::texturing {

/// Outlines this close, in the pixels of the picture they are compared in, need no correction.
inline constexpr double negligible_miss_px = 0.12;

struct OutlinePose {
  Camera camera;
  /// How firmly the outline holds the camera there (of PoseFrame's steps about the object's middle, in
  /// squares of standard deviations); zero without a stencil.
  PoseMatrix hold = PoseMatrix::Zero();
  double moved_px = 0;  // the most that a point of the outline moved in the photo
  /// Mean distance of the outlines there, in the photo; infinite if it was not measured.
  double miss_px = std::numeric_limits<double>::infinity();
  /// What the camera sees, if it was drawn at the photo's own size.
  std::optional<rendering::DepthMap> map;
};

/// Turns, shifts and zooms the camera until the outline of the mesh lies on the stencil's: the points of the
/// rim, as the depth picture shows them, are pulled along the slope of the stencil's distance field
/// (Gauss-Newton on signed distances, Fitzgibbon, BMVC 2001; robust weights by Geman and McClure), and the
/// rim is drawn anew after each step. `middle`: of the mesh. Where outlines agree to a fraction of a pixel
/// already, where that does not bring them closer, or where it would move the outline by more than `most_px`,
/// the camera stays as it was.
[[nodiscard]] OutlinePose pose_on_outline(const TriangleMesh& mesh, const Camera& camera,
                                          const Image8& stencil, const Eigen::Vector3d& middle,
                                          double most_px);

}  // namespace drape::texturing
