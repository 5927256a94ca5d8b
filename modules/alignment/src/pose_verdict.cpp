#include "pose_verdict.hpp"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

namespace drape::alignment {
namespace {

constexpr double degrees = 180 / std::numbers::pi;
constexpr double least_inliers = 0.5;  // of the outline: with less the object is another one
constexpr double good_inliers = 0.85;
constexpr double least_margin = 0.03;  // of the score, over the best other pose
constexpr double most_sigma_deg = 1.5;

struct PoseCovariance {
  PoseSigma sigma;
  double largest_rotation_deg = 0;
  Eigen::Vector3d loosest_axis = Eigen::Vector3d::UnitX();  // of rotation, in camera axes
};

std::optional<PoseCovariance> covariance_of(const RefinedPose& refined, const LensPrior& lens) {
  const Eigen::MatrixXd directions = free_directions(lens, false);
  const Eigen::MatrixXd information = directions.transpose() * refined.information * directions;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> whole(information);
  if (!(whole.eigenvalues().maxCoeff() > 0)) return std::nullopt;
  // A direction without any information is given a spread of a radian or so rather than an infinite one.
  const Eigen::VectorXd variances = whole.eigenvalues().cwiseMax(1e-3).cwiseInverse();
  const PoseMatrix covariance = directions * whole.eigenvectors() * variances.asDiagonal() *
                                whole.eigenvectors().transpose() * directions.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> rotation(
      Eigen::Matrix3d(covariance.topLeftCorner<3, 3>()));
  PoseCovariance result;
  result.largest_rotation_deg = std::sqrt(std::max(0.0, rotation.eigenvalues()[2])) * degrees;
  result.loosest_axis = rotation.eigenvectors().col(2);
  result.sigma.rotation_deg = std::sqrt(std::max(0.0, rotation.eigenvalues().sum())) * degrees;
  result.sigma.direction_deg = std::sqrt(std::max(0.0, covariance(0, 0) + covariance(1, 1))) * degrees;
  if (!lens.orthographic && !lens.fixed_focal_px && refined.pose.perspective > 0) {
    // log f = log scale - log perspective
    const double s = refined.pose.scale;
    const double p = refined.pose.perspective;
    const double variance =
        covariance(3, 3) / (s * s) + covariance(6, 6) / (p * p) - 2 * covariance(3, 6) / (s * p);
    result.sigma.focal_percent = 100 * std::sqrt(std::max(0.0, variance));
  }
  return result;
}

}  // namespace

PoseJudgement judge_poses(const std::vector<RefinedPose>& poses, const LensPrior& lens) {
  PoseJudgement judgement;
  if (poses.empty()) {
    judgement.reasons = {"no pose of the mesh has an outline like the stencil's"};
    return judgement;
  }
  const RefinedPose& best = poses.front();
  const double inliers = std::min(best.agreement.rim_inliers, best.agreement.image_inliers);
  const std::optional<PoseCovariance> covariance = covariance_of(best, lens);
  if (covariance) judgement.sigma = covariance->sigma;
  if (inliers < least_inliers || !covariance) {
    judgement.reasons.push_back(
        fmt::format("only {:.0f} % of the outline fits: is it another object?", 100 * inliers));
    return judgement;
  }
  judgement.verdict = Verdict::accept;
  const auto doubt = [&](std::string reason) {
    judgement.verdict = Verdict::review;
    judgement.reasons.push_back(std::move(reason));
  };
  if (inliers < good_inliers)
    doubt(fmt::format("{:.0f} % of the outline fits, the rest does not", 100 * inliers));
  if (covariance->largest_rotation_deg > most_sigma_deg)
    doubt(fmt::format("the outline leaves a rotation free by {:.1f} degrees",
                      covariance->largest_rotation_deg));
  if (poses.size() > 1 && best.agreement.score() - poses[1].agreement.score() < least_margin)
    doubt(fmt::format("a pose {:.0f} degrees away fits nearly as well",
                      angle_between(best.pose.rotation, poses[1].pose.rotation) * degrees));
  if (judgement.reasons.empty())
    judgement.reasons.push_back(
        fmt::format("{:.1f} % of the outline fits, to {:.2f} pixels", 100 * inliers, best.agreement.rms_px));
  return judgement;
}

}  // namespace drape::alignment
