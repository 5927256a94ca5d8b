// Photo pixels and the pixels of an ideal camera: no distortion, one focal length, no shear.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "drape/alignment/align.hpp"

namespace drape::alignment {

/// Ideal pixels are about the principal point. Without a known lens they are the photo's own, about its
/// middle.
class PhotoPlane {
 public:
  /// Error{config} for a lens that is none, or distortion of another number of terms than 0, 4 or 5.
  PhotoPlane(int width, int height, const std::optional<KnownLens>& lens);

  [[nodiscard]] Eigen::Vector2d to_ideal(const Eigen::Vector2d& photo_px) const;
  [[nodiscard]] Eigen::Vector2d to_photo(const Eigen::Vector2d& ideal_px) const;

  /// The two differ by a shift alone.
  [[nodiscard]] bool plain() const { return !lens_; }
  [[nodiscard]] const Eigen::Vector2d& principal_px() const { return principal_px_; }
  /// Of the ideal camera, where a lens is known: the geometric mean of the lens's two.
  [[nodiscard]] std::optional<double> focal_px() const;

 private:
  [[nodiscard]] Eigen::Vector2d distorted(const Eigen::Vector2d& x) const;

  std::optional<KnownLens> lens_;  // one that is not an ideal camera already
  std::optional<double> focal_px_;
  Eigen::Vector2d principal_px_;
};

}  // namespace drape::alignment
