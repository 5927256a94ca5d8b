// The linear equations that residuals of an outline make for its pose.
#pragma once

#include <vector>

#include "evidence.hpp"
#include "outline_pose.hpp"
#include "pose_refinement.hpp"

namespace drape::alignment {

/// Gauss-Newton's: matrix * step = vector. The matrix is the step's inverse covariance.
struct NormalEquations {
  PoseMatrix matrix = PoseMatrix::Zero();
  PoseVector vector = PoseVector::Zero();
  double chi_squared = 0;
};

/// What the pixel grid itself leaves of residuals, and how far along the outline they share their error.
inline constexpr OutlineNoise grid_noise{0.12, 3};

/// `residuals` must not be empty. `buffer` is scratch.
[[nodiscard]] double median_distance(const std::vector<RimResidual>& residuals, std::vector<double>& buffer);

/// Robustly, by Geman and McClure's function of `kernel_px`. The noise is that which `noise` tells, or what
/// the residuals are spread by.
[[nodiscard]] NormalEquations normal_equations(const OutlinePose& pose, const std::vector<RimSample>& rim,
                                               const std::vector<RimResidual>& residuals,
                                               double px_per_photo_px, double kernel_px,
                                               const std::optional<OutlineNoise>& noise = std::nullopt);

/// What is known of the lens.
void add_priors(const OutlinePose& pose, const LensPrior& lens, bool principal_point, NormalEquations& sum);

}  // namespace drape::alignment
