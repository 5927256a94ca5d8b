// How far a found camera is from the true one.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "drape/geometry/camera.hpp"

namespace drape::metrics {

/// Focal length in pixels: the geometric mean of the two axes' (pixels per metre for an orthographic camera).
[[nodiscard]] double focal_px(const Camera& camera);

struct CameraError {
  /// Angle of the rotation between the two camera frames.
  double rotation_deg = 0;
  /// The same after each camera has been turned, by the shortest way, to look straight at the object's
  /// centre: what the picture of the object itself shows. Turning a camera about its own centre moves the
  /// object in the picture and hardly changes how it looks; it counts in rotation_deg and not here.
  double rotation_about_ray_deg = 0;
  /// Angle at the object's centre between the directions to the two cameras.
  double direction_deg = 0;
  /// Distance of the optical centres in the world's unit; nothing if a camera is orthographic.
  std::optional<double> center_distance;
  /// 100 * (found / true - 1), signed, at the true camera's image size; nothing if one camera is perspective
  /// and the other orthographic.
  std::optional<double> focal_percent;
};

/// Both cameras map the same world; `object_center` is in it. Error{input} if a camera has no pixels or no
/// focal length.
[[nodiscard]] CameraError camera_error(const Camera& found, const Camera& truth,
                                       const Eigen::Vector3d& object_center);

}  // namespace drape::metrics
