// From about the right pose to the pose: least squares on the distances between outlines.
#pragma once

#include <optional>

#include "drape/base/progress.hpp"
#include "evidence.hpp"
#include "outline_mesh.hpp"
#include "outline_pose.hpp"

namespace drape::alignment {

/// What is known of the lens before the outline is looked at. Lengths in photo pixels.
struct LensPrior {
  bool orthographic = false;
  std::optional<double> fixed_focal_px;
  std::optional<double> hinted_focal_px;  // may be wrong: the further off, the less it pulls
  double photo_width_px = 1;
};

/// What `prior` expects of a pose's perspective, and how firmly.
struct PerspectivePrior {
  double mean = 0;
  double sigma = 1;
  bool robust = false;
};
[[nodiscard]] PerspectivePrior perspective_prior(const LensPrior& lens, double scale);

struct RefinementPlan {
  int level = 0;
  int iterations = 10;
  double reach_px = 8;        // of the first iteration, in window pixels
  double least_reach_px = 2;  // of the last
  double inlier_px = 1.5;
  bool free_principal_point = false;
  bool hold_perspective = false;  // at the start's
};

/// How rough an outline is, in window pixels.
struct OutlineNoise {
  double sigma_px = 0;
  double correlation_px = 0;  // along the outline: residuals nearer than this share their error
};

struct RefinedPose {
  OutlinePose pose;
  Agreement agreement;
  /// Inverse covariance of the free parameters about the pose, the others' rows being 0; the residuals' own
  /// spread is their noise. Zero where nothing could be matched.
  PoseMatrix information = PoseMatrix::Zero();
  /// Errors over what `information` tells of them, where that is known: of simulated photos.
  double spread = 1;
  double chi_squared = 0;  // of the residuals, robustly, for comparing fits with more and fewer parameters
};

/// Levenberg-Marquardt (Marquardt 1963) on signed distances between the drawn rim and the evidence,
/// reweighted by Geman and McClure's (1987) function of twice their median. Matches are made anew in every
/// iteration; of all iterates the one with the best agreement is kept.
[[nodiscard]] RefinedPose refine_pose(const OutlineMesh& mesh, const OutlinePose& start,
                                      const Evidence& evidence, const LensPrior& lens,
                                      const RefinementPlan& plan, OutlineDrawing& drawing);

/// Each start by itself, on all threads. Where `progress` was stopped the rest is left empty.
[[nodiscard]] std::vector<RefinedPose> refine_poses(const OutlineMesh& mesh,
                                                    const std::vector<OutlinePose>& starts,
                                                    const Evidence& evidence, const LensPrior& lens,
                                                    const RefinementPlan& plan, const Progress& progress);

/// With what the lens fixes of it.
[[nodiscard]] OutlinePose within_lens(OutlinePose pose, const LensPrior& lens);

/// The columns are the directions in which the pose may move: without those that the lens fixes.
[[nodiscard]] Eigen::MatrixXd free_directions(const LensPrior& lens, bool principal_point);

}  // namespace drape::alignment
