#include "pose_refinement.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "drape/base/parallel.hpp"
#include "outline_equations.hpp"

namespace drape::alignment {
namespace {

constexpr double most_turn_rad = 0.35;
// Relative, of the diagonal: rotation, perspective and place are told apart by differences of a thousandth.
constexpr double least_damping = 1e-6;
constexpr double at_rest_sigmas = 0.1;
constexpr int patient_iterations = 8;  // plans of so many may take twice as many to come to rest
constexpr double least_kernel_px = 0.5;

}  // namespace

OutlinePose within_lens(OutlinePose pose, const LensPrior& lens) {
  if (lens.orthographic) pose.perspective = 0;
  if (lens.fixed_focal_px) pose.perspective = std::min(0.85, pose.scale / *lens.fixed_focal_px);
  return pose;
}

PerspectivePrior perspective_prior(const LensPrior& lens, double scale) {
  if (lens.hinted_focal_px) {
    const double expected = scale / *lens.hinted_focal_px;
    return {expected, 0.05 * expected, true};
  }
  // Focal lengths of 0.6 to 6 widths: perspective = scale / focal length lies about here, and may be 0.
  const double widths = scale / lens.photo_width_px;
  return {0.6 * widths, 0.5 * widths, false};
}

Eigen::MatrixXd free_directions(const LensPrior& lens, bool principal_point) {
  const bool free_perspective = !lens.orthographic && !lens.fixed_focal_px;
  Eigen::MatrixXd directions =
      Eigen::MatrixXd::Zero(pose_parameters, 6 + (free_perspective ? 1 : 0) + (principal_point ? 2 : 0));
  directions.topLeftCorner<6, 6>().setIdentity();
  if (lens.fixed_focal_px) directions(6, 3) = 1 / *lens.fixed_focal_px;
  if (free_perspective) directions(6, 6) = 1;
  if (principal_point) directions.bottomRightCorner<2, 2>().setIdentity();
  return directions;
}

RefinedPose refine_pose(const OutlineMesh& mesh, const OutlinePose& start, const Evidence& evidence,
                        const LensPrior& lens, const RefinementPlan& plan, OutlineDrawing& drawing) {
  const Window& window = evidence.window(plan.level);
  Eigen::MatrixXd directions = free_directions(lens, plan.free_principal_point);
  if (plan.hold_perspective && !lens.fixed_focal_px) directions = directions.leftCols<6>().eval();
  std::vector<RimResidual> residuals;
  std::vector<double> buffer;
  RefinedPose best;
  best.pose = within_lens(start, lens);
  OutlinePose pose = best.pose;
  bool first = true;
  bool settled = false;
  for (int i = 0; i <= 2 * plan.iterations; ++i) {
    const double share = settled ? 1 : std::min(1.0, static_cast<double>(i) / std::max(1, plan.iterations));
    const double reach = plan.reach_px * std::pow(plan.least_reach_px / plan.reach_px, share);
    drawing.draw(mesh, pose, window);
    const Agreement agreement = evidence.match(drawing, plan.level, reach, plan.inlier_px, residuals);
    if (residuals.size() < 6) {
      if (first) best.agreement = agreement;
      break;
    }
    const double kernel = std::max(least_kernel_px, 2 * median_distance(residuals, buffer));
    NormalEquations sum = normal_equations(pose, drawing.rim(), residuals, window.px_per_photo_px, kernel);
    add_priors(pose, lens, plan.free_principal_point, sum);
    if (first || agreement.closeness() > best.agreement.closeness()) {
      best = {pose, agreement, sum.matrix, 1, sum.chi_squared};
      first = false;
    }
    Eigen::MatrixXd matrix = directions.transpose() * sum.matrix * directions;
    matrix.diagonal() *= 1 + least_damping;
    const Eigen::VectorXd solution = matrix.ldlt().solve(directions.transpose() * sum.vector);
    PoseVector step = directions * solution;
    if (!step.allFinite()) break;
    // Against the spread that the residuals leave. What has come to rest is looked at once more with the
    // least reach, within which less of the wrong outline is.
    const bool at_rest = step.dot(sum.matrix * step) < at_rest_sigmas * at_rest_sigmas;
    if (at_rest && share == 1) break;
    if (i >= plan.iterations && plan.iterations < patient_iterations) break;
    settled |= at_rest;
    const double turn = step.head<3>().norm();
    if (turn > most_turn_rad) step *= most_turn_rad / turn;
    pose = within_lens(moved(pose, step), lens);
  }
  return best;
}

std::vector<RefinedPose> refine_poses(const OutlineMesh& mesh, const std::vector<OutlinePose>& starts,
                                      const Evidence& evidence, const LensPrior& lens,
                                      const RefinementPlan& plan, const Progress& progress) {
  std::vector<RefinedPose> refined(starts.size());
  parallel_for(starts.size(), 1, [&](std::size_t begin, std::size_t end) {
    OutlineDrawing drawing;
    for (std::size_t i = begin; i < end; ++i) {
      if (progress.stop_requested()) return;
      refined[i] = refine_pose(mesh, starts[i], evidence, lens, plan, drawing);
    }
  });
  return refined;
}

}  // namespace drape::alignment
