// How far each place of a photo is from the outline of a stencil.
#pragma once

#include <Eigen/Core>

#include "drape/geometry/image.hpp"

namespace drape::texturing {

/// Signed distances, positive inside, in pixels; smoothed a little, so that the steps of pixels do not show.
class DistanceField {
 public:
  /// Of every step-th pixel of the stencil; unknown pixels count as outside.
  DistanceField(const Image8& stencil, int step);

  /// Bilinear, at a position in the photo's pixels; beyond the photo as on its border.
  [[nodiscard]] double at(const Eigen::Vector2d& pixel) const;
  /// Its derivative, by differences over three steps.
  [[nodiscard]] Eigen::Vector2d slope_at(const Eigen::Vector2d& pixel) const;

  [[nodiscard]] const ImageF& values() const { return values_; }
  [[nodiscard]] int step() const { return step_; }

 private:
  ImageF values_;
  int step_;
};

}  // namespace drape::texturing
