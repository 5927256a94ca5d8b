// A smooth shift of a few pixels that lays the model's outline on the photo's.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "drape/geometry/image.hpp"

namespace drape::texturing {

/// Where in the photo to look for what the camera projects to a pixel. Without controls: just there.
class OutlineWarp {
 public:
  OutlineWarp() = default;
  /// Uniform cubic B-spline: controls of columns x rows, the first one a cell up and left of `origin`.
  OutlineWarp(const Eigen::Vector2d& origin, double cell, int columns, int rows,
              std::vector<Eigen::Vector2d> controls, double most_px);

  [[nodiscard]] Eigen::Vector2d operator()(const Eigen::Vector2d& pixel) const {
    return controls_.empty() ? pixel : Eigen::Vector2d(pixel + shift_at(pixel));
  }
  [[nodiscard]] bool moves() const { return !controls_.empty(); }
  [[nodiscard]] Eigen::Vector2d shift_at(const Eigen::Vector2d& pixel) const;

 private:
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  double cell_ = 1;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<Eigen::Vector2d> controls_;
  double most_px_ = 0;
};

struct SnappedOutline {
  OutlineWarp warp;
  double largest_px = 0;  // of the warp along the outline
};

/// Fits the warp to the outlines of two stencils of the same size: along its normal each point of the model's
/// outline goes to the photo's, bending is penalised, an affine shift is not; points that would move by more
/// than a little over `most_px` do not count (robust non-rigid registration by distance fields after
/// Fitzgibbon, "Robust registration of 2D and 3D point sets", BMVC 2001, with the free-form deformation of
/// Rueckert et al. 1999). No warp moves anything by more than most_px. No warp at all if most_px is 0, the
/// outlines agree to a fraction of a pixel already, or it would not bring them closer.
[[nodiscard]] SnappedOutline snapped_outline(const Image8& model, const Image8& photo, double most_px);

}  // namespace drape::texturing
