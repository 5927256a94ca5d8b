// Points as squares on a picture with a depth buffer.
#pragma once

#include <Eigen/Core>

#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"

namespace drape::report {

/// What the nearest point at every pixel looks like. Of equally near points the first drawn stays.
class PointRaster {
 public:
  explicit PointRaster(const Camera& camera);

  /// A disc of this diameter round the point's pixel (at least the one pixel that it falls on).
  void draw(const Eigen::Vector3d& point_in_world, double diameter_in_world, const Eigen::Vector3f& light);

  /// sRGB-encoded, over the background (sRGB, 0..1): light times eye-dome shading.
  [[nodiscard]] Image8 picture(const Eigen::Vector3f& background) const;

 private:
  [[nodiscard]] float shading(int x, int y) const;

  Camera camera_;
  double focal_px_;
  ImageF depth_;  // +infinity where there is nothing
  Image<Eigen::Vector3f> light_;
};

}  // namespace drape::report
