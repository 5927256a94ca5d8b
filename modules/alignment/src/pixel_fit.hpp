// The last step of an alignment by a clean stencil: what each of its pixels says.
#pragma once

#include "drape/base/progress.hpp"
#include "pose_refinement.hpp"
#include "stencil_evidence.hpp"

namespace drape::alignment {

/// Two neighbours of which one is object tell more than that the outline passes half way between them: it
/// lies nowhere else than between their centres. Where the stencil is a drawing of the object itself, all of
/// these intervals can be met at once, and by few poses. Maximum likelihood for observations that are known
/// by intervals (Tobin 1958; Gentleman and Geyer 1994), the outline's deviation ever smaller, by Newton's
/// method; of all iterates the one with the greatest overlap is kept. Gives `start` back where none has a
/// greater one than it.
[[nodiscard]] RefinedPose fit_to_pixels(const OutlineMesh& mesh, const RefinedPose& start,
                                        const StencilEvidence& evidence, const LensPrior& lens);

/// Of a Gaussian of deviation `sigma` about 0, that it lies within `low` and `high`: the logarithm's first
/// derivative and negative second derivative by a shift of the Gaussian.
struct IntervalLikelihood {
  double slope = 0;
  double curvature = 0;
};
[[nodiscard]] IntervalLikelihood interval_likelihood(double low, double high, double sigma);

}  // namespace drape::alignment
