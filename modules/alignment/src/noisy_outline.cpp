#include "noisy_outline.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace drape::alignment {
namespace {

constexpr double deviations_per_median = 1.4826;  // of a normal distribution
constexpr double reach_deviations = 3.5;
constexpr double kernel_deviations = 4;
constexpr double inlier_deviations = 2.5;
constexpr double least_reach_px = 1.5;
constexpr double glance_reach_px = 6;
constexpr std::size_t sampled = 1200;  // of the residuals, for their correlation
constexpr int most_correlation_px = 40;
constexpr double faded = 0.1;
constexpr double same_side = 0.5;
constexpr int rounds = 12;
constexpr double at_rest_sigmas = 0.05;
constexpr double most_turn_rad = 0.1;

// The mean of products of residuals at each distance, over that of their squares.
double correlation_length(const std::vector<RimSample>& rim, const std::vector<const RimResidual*>& chosen) {
  std::array<double, most_correlation_px> products{};
  std::array<double, most_correlation_px> counts{};
  double squares = 0;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    squares += chosen[i]->distance_px * chosen[i]->distance_px;
    const RimSample& a = rim[chosen[i]->sample];
    for (std::size_t j = i + 1; j < chosen.size(); ++j) {
      const RimSample& b = rim[chosen[j]->sample];
      const Eigen::Vector2d between = a.at - b.at;
      if (std::abs(between.x()) >= most_correlation_px || std::abs(between.y()) >= most_correlation_px)
        continue;
      const double distance = between.norm();
      if (distance >= most_correlation_px || a.outward.dot(b.outward) < same_side) continue;
      const auto bin = static_cast<std::size_t>(distance);
      products[bin] += chosen[i]->distance_px * chosen[j]->distance_px;
      counts[bin] += 1;
    }
  }
  const double variance = squares / static_cast<double>(std::max<std::size_t>(1, chosen.size()));
  double length = 0;
  double correlation = 1;
  for (std::size_t bin = 0; bin < products.size() && variance > 0; ++bin) {
    // Samples at regular distances leave bins without pairs: there it is what it was before.
    if (counts[bin] > 0) correlation = products[bin] / counts[bin] / variance;
    if (correlation < faded) break;
    length += 2 * correlation;
  }
  return length;
}

void measure_along_normals(const std::vector<RimSample>& rim, std::vector<RimResidual>& residuals) {
  for (RimResidual& r : residuals) {
    r.direction = rim[r.sample].outward;
    r.distance_px = r.direction.dot(r.offset);
  }
}

}  // namespace

OutlineNoise outline_noise(const std::vector<RimSample>& rim, const std::vector<RimResidual>& residuals) {
  OutlineNoise noise = grid_noise;
  if (residuals.empty()) return noise;
  std::vector<double> buffer;
  noise.sigma_px = std::max(noise.sigma_px, deviations_per_median * median_distance(residuals, buffer));
  std::vector<const RimResidual*> chosen;
  const std::size_t stride = (residuals.size() + sampled - 1) / sampled;
  for (std::size_t i = 0; i < residuals.size(); i += stride)
    if (std::abs(residuals[i].distance_px) < reach_deviations * noise.sigma_px)
      chosen.push_back(&residuals[i]);
  noise.correlation_px = std::max(noise.correlation_px, correlation_length(rim, chosen));
  return noise;
}

double inlier_px(const OutlineNoise& noise) {
  return std::max(1.0, inlier_deviations * noise.sigma_px);
}

NormalEquations NoisyOutline::equations(const OutlinePose& pose) {
  const Window& window = evidence_.window(level_);
  drawing_.draw(mesh_, pose, window);
  const double reach = std::clamp(reach_deviations * noise_.sigma_px, least_reach_px, most_noise_reach_px);
  agreement_ = evidence_.match(drawing_, level_, reach, inlier_px(noise_), residuals_);
  measure_along_normals(drawing_.rim(), residuals_);
  NormalEquations sum = normal_equations(pose, drawing_.rim(), residuals_, window.px_per_photo_px,
                                         std::max(0.5, kernel_deviations * noise_.sigma_px), noise_);
  add_priors(pose, lens_, false, sum);
  return sum;
}

RefinedPose settled_pose(NoisyOutline& outline, const OutlinePose& start) {
  const Eigen::MatrixXd directions = free_directions(outline.lens(), false);
  RefinedPose settled;
  OutlinePose pose = start;
  for (int round = 0; round < rounds; ++round) {
    const NormalEquations sum = outline.equations(pose);
    if (!outline.matched()) break;
    settled.pose = pose;
    settled.agreement = outline.agreement();
    settled.information = sum.matrix;
    settled.chi_squared = sum.chi_squared;
    Eigen::MatrixXd matrix = directions.transpose() * sum.matrix * directions;
    matrix.diagonal() *= 1 + 1e-6;
    PoseVector step = directions * matrix.ldlt().solve(directions.transpose() * sum.vector);
    if (!step.allFinite() || step.dot(sum.matrix * step) < at_rest_sigmas * at_rest_sigmas) break;
    const double turn = step.head<3>().norm();
    if (turn > most_turn_rad) step *= most_turn_rad / turn;
    pose = within_lens(moved(pose, step), outline.lens());
  }
  return settled;
}

OutlineNoise noise_about(const OutlineMesh& mesh, const OutlinePose& pose, const Evidence& evidence,
                         int level) {
  OutlineDrawing drawing;
  std::vector<RimResidual> residuals;
  drawing.draw(mesh, pose, evidence.window(level));
  (void)evidence.match(drawing, level, glance_reach_px, 1, residuals);
  measure_along_normals(drawing.rim(), residuals);
  return outline_noise(drawing.rim(), residuals);
}

}  // namespace drape::alignment
