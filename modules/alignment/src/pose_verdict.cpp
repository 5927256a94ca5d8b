#include "pose_verdict.hpp"

#include "verdict_limits.hpp"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace drape::alignment {
namespace {

constexpr double degrees = 180 / std::numbers::pi;
constexpr double most_sigma_deg = 0.8;
constexpr double margin_per_px = 0.02;      // of noise: chance tells poses apart the less, the rougher
constexpr double most_noise_px = 2;         // beyond, the margin grows no more
constexpr double most_noise_share = 0.012;  // of the object: with more, another object would fit as well
constexpr double most_gap = 0.4;            // of the outline, in one place
constexpr double good_elsewhere = 0.95;     // of the rest
// Where light explains most of what is inside, what is left of the right pose is the photo's noise: nearly
// every sample has its own. A wrong one leaves whole shapes (simulated photos: 178 and more against 58 to
// 90).
constexpr double least_independent = 130;
// Seen through an open side: what the scan lacks there may be in front of what it has.
constexpr double most_inner_side = 0.85;
constexpr double same_axis = 0.95;    // cosine
constexpr double free_sigma_deg = 8;  // about one axis: the outline hardly changes with the rotation

struct PoseCovariance {
  PoseSigma sigma;
  double largest_rotation_deg = 0;
  double looseness = 1;  // the largest spread of rotation over the next one
  Eigen::Vector3d loosest_axis = Eigen::Vector3d::UnitX();  // of rotation, in camera axes
};

std::optional<PoseCovariance> covariance_of(const RefinedPose& refined, const LensPrior& lens) {
  const Eigen::MatrixXd directions = free_directions(lens, false);
  const Eigen::MatrixXd information = directions.transpose() * refined.information * directions;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> whole(information);
  if (!(whole.eigenvalues().maxCoeff() > 0)) return std::nullopt;
  // A direction without any information is given a large spread rather than an infinite one.
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
  for (double* deviation :
       {&result.sigma.rotation_deg, &result.sigma.direction_deg, &result.sigma.focal_percent})
    *deviation *= refined.spread;
  return result;
}

// The axis of the mesh about which the outline leaves it free: because the outline hardly changes, or because
// it changes least about the axis that the next best pose is turned about (a body of rotation with facets).
std::optional<Eigen::Vector3d> free_axis_of(const RefinedPose& best, const RefinedPose* rival,
                                            const PoseCovariance& covariance) {
  const Eigen::Vector3d axis = best.pose.rotation.transpose() * covariance.loosest_axis;
  if (covariance.largest_rotation_deg > free_sigma_deg) return axis;
  if (rival == nullptr) return std::nullopt;
  const Eigen::AngleAxisd between(Eigen::Matrix3d(best.pose.rotation.transpose() * rival->pose.rotation));
  if (std::abs(between.axis().dot(axis)) < same_axis) return std::nullopt;
  return axis;
}

// What the pixel grid leaves asks for no larger margin.
double rough_px(const OutlineFigures& figures) {
  return figures.noise_px < 0.4 ? 0 : std::min(figures.noise_px, most_noise_px);
}

}  // namespace

OutlineDoubts outline_doubts(double inliers, const OutlineFigures& figures, double enough) {
  OutlineDoubts doubts;
  const bool gap_alone =
      figures.largest_gap < most_gap && figures.fits > good_elsewhere * (1 - figures.largest_gap);
  if (inliers < enough && !gap_alone)
    doubts.reasons.push_back(fmt::format("{:.0f} % of the outline fits, the rest does not", 100 * inliers));
  if (inliers < enough && gap_alone)
    doubts.forgiven = fmt::format(
        "all but one part of the outline fits ({:.0f} % of it): hidden, or something was taken along",
        100 * figures.largest_gap);
  if (figures.noise_px > most_noise_share * figures.object_px)
    doubts.reasons.push_back(
        fmt::format("the outline is off by {:.1f} pixels all along: too much for an object of {:.0f}",
                    figures.noise_px, figures.object_px));
  return doubts;
}

double needed_margin(const OutlineFigures& figures) {
  return least_margin + margin_per_px * rough_px(figures);
}

std::optional<PoseSigma> pose_sigma(const RefinedPose& pose, const LensPrior& lens) {
  const std::optional<PoseCovariance> covariance = covariance_of(pose, lens);
  return covariance ? std::optional<PoseSigma>(covariance->sigma) : std::nullopt;
}

PoseJudgement judge_poses(const std::vector<RefinedPose>& poses, const LensPrior& lens,
                          OutlineFigures& figures) {
  PoseJudgement judgement;
  if (poses.empty()) {
    judgement.reasons = {"no pose of the mesh has an outline like the stencil's"};
    return judgement;
  }
  const RefinedPose& best = poses.front();
  const double inliers = std::min(best.agreement.rim_inliers, best.agreement.image_inliers);
  const std::optional<PoseCovariance> covariance = covariance_of(best, lens);
  if (covariance) judgement.sigma = covariance->sigma;
  figures.margin = poses.size() > 1 ? best.agreement.score() - poses[1].agreement.score() : 1;
  figures.rotation_deg = covariance ? covariance->largest_rotation_deg : 180;
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
  const OutlineDoubts doubts = outline_doubts(inliers, figures, good_inliers);
  for (const std::string& reason : doubts.reasons) doubt(reason);
  if (figures.explained > light_explains && figures.independent < least_independent)
    doubt("the photo shows shapes inside the outline where the mesh has none");
  if (figures.inner_side > most_inner_side)
    doubt(
        fmt::format("{:.0f} % of what it shows is the inner side of an open scan", 100 * figures.inner_side));
  const double margin = needed_margin(figures);
  while (judgement.rivals + 1 < poses.size() &&
         best.agreement.score() - poses[judgement.rivals + 1].agreement.score() < margin)
    ++judgement.rivals;
  judgement.free_axis = free_axis_of(best, judgement.rivals > 0 ? &poses[1] : nullptr, *covariance);
  if (judgement.free_axis) {
    doubt(fmt::format("free about the axis ({:.2f}, {:.2f}, {:.2f}) of the mesh: its outline stays the same",
                      judgement.free_axis->x(), judgement.free_axis->y(), judgement.free_axis->z()));
  } else if (covariance->largest_rotation_deg > most_sigma_deg)
    doubt(fmt::format("the outline leaves a rotation free by {:.1f} degrees",
                      covariance->largest_rotation_deg));
  if (judgement.rivals > 0)
    doubt(fmt::format(
        "a pose {:.0f} degrees away fits nearly as well: a mirror twin, or a symmetry of the object",
        angle_between(best.pose.rotation, poses[1].pose.rotation) * degrees));
  if (judgement.reasons.empty() && !doubts.forgiven.empty()) judgement.reasons.push_back(doubts.forgiven);
  if (judgement.reasons.empty())
    judgement.reasons.push_back(fmt::format("{:.1f} % of the outline fits, to {:.2f} pixels{}", 100 * inliers,
                                            best.agreement.rms_px,
                                            figures.by_photo ? "; the light inside agrees" : ""));
  return judgement;
}

}  // namespace drape::alignment
