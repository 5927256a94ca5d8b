// The colours of one photo, with the object's grown over everything else.
#pragma once

#include <Eigen/Core>

#include "grown_photo.hpp"

namespace drape::texturing {

class PhotoColors {
 public:
  PhotoColors() = default;
  /// Grown within the box of the pixels that may be used and a margin for filters.
  PhotoColors(const PhotoPixels& photo, const Image8& trusted);

  /// Linear light at a position in the photo, by a cubic through the sixteen pixels round it: where charts
  /// lie on other grids than their photos, it keeps more of fine patterns than straight lines between pixels
  /// would. Within 0..1; beyond the box as on its border.
  [[nodiscard]] Eigen::Vector3f at(const Eigen::Vector2d& pixel) const;
  /// Mean of the 3 x 3 pixels round it: less noise.
  [[nodiscard]] Eigen::Vector3f smooth_at(const Eigen::Vector2d& pixel) const;
  /// How far the logs of those pixels are apart: standard deviation, mean of the channels.
  [[nodiscard]] float contrast_at(const Eigen::Vector2d& pixel) const;

 private:
  [[nodiscard]] Eigen::Vector2d in_box(const Eigen::Vector2d& pixel) const;
  [[nodiscard]] Eigen::Vector3f quickly_at(const Eigen::Vector2d& pixel) const;

  PixelBox box_{};
  Image8 grown_;
  Image16 deep_grown_;  // instead of it, where the photo is painted in 16 bits
};

/// Log of light, with a floor that keeps the noise of dark colours small.
[[nodiscard]] Eigen::Vector3f log_light(const Eigen::Vector3f& linear);

}  // namespace drape::texturing
