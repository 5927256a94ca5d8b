// Where light from far away arrives.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "drape/geometry/bounding_box.hpp"
#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"
#include "drape/rendering/renderer.hpp"

namespace drape::rendering {

/// The distances of a mesh's nearest surface along one direction (Williams, "Casting curved shadows on curved
/// surfaces", 1978). Lookups may run on several threads at once.
class ShadowMap {
 public:
  /// `towards_light`: unit length. `box`: what the mesh lies in. side x side texels.
  ShadowMap(Renderer& renderer, const BoundingBox& box, const Eigen::Vector3d& towards_light, int side);

  /// How much of the light reaches a surface point, 0..1: the four texels round it, compared with its depth
  /// and then weighted bilinearly (percentage closer filtering; Reeves, Salesin, Cook 1987). The point is
  /// moved off the surface along `normal` (unit length) by two texels, so that a surface does not shadow
  /// itself however obliquely the light falls.
  [[nodiscard]] float lit(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const;

 private:
  Camera camera_;
  Eigen::Matrix<double, 3, 4> local_from_world_;  // texel x, texel y, depth
  double texel_ = 0;
  ImageF depth_;
};

/// The same for light from a disc of `radius_rad` about the direction: the mean of `maps` maps spread over
/// it.
class SoftShadow {
 public:
  SoftShadow(Renderer& renderer, const BoundingBox& box, const Eigen::Vector3d& towards_light,
             double radius_rad, int maps, int side);
  [[nodiscard]] float lit(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const;

 private:
  std::vector<ShadowMap> maps_;
};

}  // namespace drape::rendering
