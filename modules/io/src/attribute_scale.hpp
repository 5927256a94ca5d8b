// What foreign files say of points, brought to what drape means by it.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace drape::io {

/// The formats do not say what unit intensities have, so the values tell: within 0..1 they stay; else within
/// 0..255, 0..65535 or -2048..2047 (Leica) they are taken as that range; else they are divided by the
/// largest. What is not finite becomes 0. `full_scale` is the value that means 1 where the type tells it (255
/// for bytes); 0 if it does not.
[[nodiscard]] std::vector<float> scaled_intensities(std::vector<float> values, double full_scale = 0);

/// Within 0..1 colours stay; else they are taken as 0..255, or 0..65535 if one is larger. `full_scale` as
/// above.
[[nodiscard]] std::vector<Eigen::Vector3f> scaled_colors(std::vector<Eigen::Vector3f> colors,
                                                         double full_scale = 0);

/// Unit length; zero for a normal that is zero or not finite.
[[nodiscard]] Eigen::Vector3f unit_normal(const Eigen::Vector3d& normal);
[[nodiscard]] std::vector<Eigen::Vector3f> unit_normals(std::span<const Eigen::Vector3d> normals);

/// Clamped to 0..1; 0 for what is not finite.
[[nodiscard]] float clamped_confidence(double value);
[[nodiscard]] std::vector<float> clamped_confidences(std::span<const double> values);

}  // namespace drape::io
