// Outlines that are rough: how rough, and the pose that fits them best.
#pragma once

#include <vector>

#include "outline_equations.hpp"

namespace drape::alignment {

/// The spread of `residuals` (1.4826 of their median) and the length along the outline over which they share
/// their error: the sum of their autocorrelation over both sides, up to where it has faded. Nothing less than
/// what the pixel grid leaves.
[[nodiscard]] OutlineNoise outline_noise(const std::vector<RimSample>& rim,
                                         const std::vector<RimResidual>& residuals);

inline constexpr double most_noise_reach_px = 8;  // as far as a level knows its contour

/// How far off a piece may be and still be on the outline: 2.5 deviations, or a pixel.
[[nodiscard]] double inlier_px(const OutlineNoise& noise);

/// A pose's equations where the outline has this noise: no residual within three deviations is left out or
/// weighs much less than the others, and each is measured along the model's own normal, since the rough
/// outline's is no good. `agreement` counts what lies within 2.5 deviations (a pixel at least) as inliers.
class NoisyOutline {
 public:
  NoisyOutline(const OutlineMesh& mesh, const Evidence& evidence, const LensPrior& lens, int level,
               const OutlineNoise& noise)
      : mesh_(mesh), evidence_(evidence), lens_(lens), level_(level), noise_(noise) {}

  [[nodiscard]] NormalEquations equations(const OutlinePose& pose);
  [[nodiscard]] const Agreement& agreement() const { return agreement_; }  // of the last pose
  [[nodiscard]] const LensPrior& lens() const { return lens_; }
  [[nodiscard]] bool matched() const { return residuals_.size() >= 6; }

 private:
  const OutlineMesh& mesh_;
  const Evidence& evidence_;
  const LensPrior& lens_;
  int level_;
  OutlineNoise noise_;
  OutlineDrawing drawing_;
  std::vector<RimResidual> residuals_;
  Agreement agreement_;
};

/// The pose at rest, from one that is about right.
[[nodiscard]] RefinedPose settled_pose(NoisyOutline& outline, const OutlinePose& start);

/// How rough the evidence's outline is about a pose, at a level.
[[nodiscard]] OutlineNoise noise_about(const OutlineMesh& mesh, const OutlinePose& pose,
                                       const Evidence& evidence, int level);

}  // namespace drape::alignment
