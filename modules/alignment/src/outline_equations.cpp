#include "outline_equations.hpp"

#include <algorithm>
#include <cmath>

namespace drape::alignment {
namespace {

constexpr double principal_point_sigma = 0.03;  // of the photo's width

}  // namespace

double median_distance(const std::vector<RimResidual>& residuals, std::vector<double>& buffer) {
  buffer.clear();
  for (const RimResidual& r : residuals) buffer.push_back(std::abs(r.distance_px));
  const auto middle = buffer.begin() + static_cast<std::ptrdiff_t>(buffer.size() / 2);
  std::nth_element(buffer.begin(), middle, buffer.end());
  return *middle;
}

NormalEquations normal_equations(const OutlinePose& pose, const std::vector<RimSample>& rim,
                                 const std::vector<RimResidual>& residuals, double px_per_photo_px,
                                 double kernel_px, const std::optional<OutlineNoise>& noise) {
  NormalEquations sum;
  double squares = 0;
  double weights = 0;
  for (const RimResidual& r : residuals) {
    const double k = kernel_px * kernel_px / (kernel_px * kernel_px + r.distance_px * r.distance_px);
    const double weight = r.weight * k * k;
    PoseVector d = place_derivative(pose, rim[r.sample].turned, r.direction) * px_per_photo_px;
    sum.vector += weight * r.distance_px * d;
    sum.matrix.selfadjointView<Eigen::Lower>().rankUpdate(d, weight);
    sum.chi_squared += r.weight * r.distance_px * r.distance_px * k;
    squares += weight * r.distance_px * r.distance_px;
    weights += weight;
  }
  const double grid = grid_noise.sigma_px * grid_noise.sigma_px;
  const double variance =
      noise ? noise->sigma_px * noise->sigma_px : std::max(grid, weights > 0 ? squares / weights : 0.0);
  const double correlation = noise ? noise->correlation_px : grid_noise.correlation_px;
  // Forward and backward residuals look at the same outline from both sides: each counts half.
  const double confidence = 0.5 / (variance * correlation);
  sum.matrix = (confidence * PoseMatrix(sum.matrix.selfadjointView<Eigen::Lower>())).eval();
  sum.vector *= confidence;
  sum.chi_squared *= noise ? confidence : 0.5 / (grid * grid_noise.correlation_px);
  return sum;
}

void add_priors(const OutlinePose& pose, const LensPrior& lens, bool principal_point, NormalEquations& sum) {
  if (!lens.orthographic && !lens.fixed_focal_px) {
    const PerspectivePrior prior = perspective_prior(lens, pose.scale);
    const double off = (prior.mean - pose.perspective) / prior.sigma;
    const double weight = prior.robust ? 1 / (1 + off * off) : 1.0;
    sum.matrix(6, 6) += weight / (prior.sigma * prior.sigma);
    sum.vector[6] += weight * off / prior.sigma;
  }
  if (principal_point) {
    const double sigma = principal_point_sigma * lens.photo_width_px;
    for (int i = 7; i < 9; ++i) {
      sum.matrix(i, i) += 1 / (sigma * sigma);
      sum.vector[i] -= pose.principal[i - 7] / (sigma * sigma);
    }
  }
}

}  // namespace drape::alignment
