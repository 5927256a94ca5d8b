// Small changes of a camera, and what they do to pixels.
#pragma once

#include <Eigen/Core>

#include "drape/geometry/camera.hpp"

namespace drape::texturing {

/// A rotation vector about the pivot (radians), a shift in units of the pivot's distance (of a camera
/// frame's own unit if orthographic), and the log of a zoom; all in the camera's frame.
using PoseStep = Eigen::Matrix<double, 7, 1>;
using PoseMatrix = Eigen::Matrix<double, 7, 7>;

class PoseFrame {
 public:
  /// `middle`: of the object, in the world.
  PoseFrame(const Camera& camera, const Eigen::Vector3d& middle);

  [[nodiscard]] const Camera& camera() const { return camera_; }
  [[nodiscard]] Camera moved(const PoseStep& step) const;
  /// How a point's pixel changes with the step, at zero.
  [[nodiscard]] Eigen::Matrix<double, 2, 7> jacobian(const Eigen::Vector3d& point_in_world) const;

 private:
  Camera camera_;
  Eigen::Vector3d pivot_;  // in the camera's frame
  double unit_;            // of shifts
};

/// Diagonal of a weak prior on steps: what an aligner may leave (a degree or so, some percent of distance and
/// focal length). It decides only what nothing else does.
[[nodiscard]] PoseMatrix prior_on_steps();

}  // namespace drape::texturing
