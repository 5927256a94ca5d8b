#include "pixel_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "outline_equations.hpp"

namespace drape::alignment {
namespace {

constexpr std::array<double, 10> sigmas_px = {0.3, 0.2, 0.15, 0.1, 0.07, 0.05, 0.05, 0.035, 0.025, 0.025};
constexpr int most_offset = 2;           // pixels, of the photo's outline against the pose's
constexpr double least_component = 0.4;  // of the normal, along the line on which the crossing lies
constexpr double kernel_sigmas = 4;      // of how far an interval is missed by
constexpr double least_kernel_px = 0.3;
constexpr double loose =
    0.02;  // of the curvature that an exact observation has: no direction is left without
constexpr double most_turn_rad = 0.02;
constexpr double reach_px = 1.5;
constexpr double inlier_px = 1;

bool set_in(const BitImage& image, const PixelCrossing& crossing, int at) {
  return crossing.in_row ? image.at(at, crossing.line) : image.at(crossing.line, at);
}

// How far the photo's outline lies ahead of the crossing, outward: between the two, in pixels.
struct Interval {
  double low = 0;
  double high = 0;
  [[nodiscard]] double missed_by() const { return std::max({0.0, low, -high}); }
};

std::optional<Interval> interval_of(const PixelCrossing& crossing, const StencilLevel& level) {
  const int along = crossing.in_row ? 0 : 1;
  for (const int offset : {0, 1, -1, 2, -2}) {
    static_assert(most_offset == 2);
    const int before = crossing.before + offset;
    if (!set_in(level.known, crossing, before) || !set_in(level.known, crossing, before + 1)) continue;
    if (set_in(level.object, crossing, before) != crossing.object_first ||
        set_in(level.object, crossing, before + 1) == crossing.object_first)
      continue;
    const double component = crossing.outward[along];
    const double a = (before + 0.5 - crossing.at[along]) * component;
    const double b = (before + 1.5 - crossing.at[along]) * component;
    return Interval{std::min(a, b), std::max(a, b)};
  }
  return std::nullopt;
}

// Beside a hole of the scan, the rim is not the object's.
bool at_hole(const PixelCrossing& crossing, const OutlineDrawing& drawing, const StencilLevel& level) {
  if (drawing.gaps().words().empty()) return false;
  const int beside = crossing.object_first ? crossing.before + 1 : crossing.before;
  const int further = crossing.object_first ? crossing.before + 3 : crossing.before - 2;
  return (set_in(drawing.gaps(), crossing, beside) && set_in(level.object, crossing, beside)) ||
         (crossing.border && set_in(level.object, crossing, further));
}

NormalEquations equations(const std::vector<PixelCrossing>& crossings, const OutlineDrawing& drawing,
                          const StencilLevel& level, const OutlinePose& pose, double sigma) {
  NormalEquations sum;
  const double kernel = std::max(least_kernel_px, kernel_sigmas * sigma);
  for (const PixelCrossing& crossing : crossings) {
    if (std::abs(crossing.outward[crossing.in_row ? 0 : 1]) < least_component) continue;
    if (at_hole(crossing, drawing, level)) continue;
    const std::optional<Interval> interval = interval_of(crossing, level);
    if (!interval) continue;
    const double missed = interval->missed_by();
    const double k = kernel * kernel / (kernel * kernel + missed * missed);
    const IntervalLikelihood likelihood = interval_likelihood(interval->low, interval->high, sigma);
    const PoseVector d =
        place_derivative(pose, crossing.turned, crossing.outward) * level.window.px_per_photo_px;
    sum.vector += k * k * likelihood.slope * d;
    sum.matrix.selfadjointView<Eigen::Lower>().rankUpdate(
        d, k * k * std::max(likelihood.curvature, loose / (sigma * sigma)));
  }
  sum.matrix = PoseMatrix(sum.matrix.selfadjointView<Eigen::Lower>());
  return sum;
}

}  // namespace

IntervalLikelihood interval_likelihood(double low, double high, double sigma) {
  const double a = low / sigma;
  const double b = high / sigma;
  const auto density = [](double x) { return std::exp(-x * x / 2) / std::sqrt(2 * std::numbers::pi); };
  // Both ends on the side where the tail is small and exact.
  const double inside = a > 0
                            ? (std::erfc(a / std::numbers::sqrt2) - std::erfc(b / std::numbers::sqrt2)) / 2
                            : (std::erfc(-b / std::numbers::sqrt2) - std::erfc(-a / std::numbers::sqrt2)) / 2;
  if (inside < 1e-200) {
    // Far in a tail the nearer end is what was observed.
    const double nearer = a > 0 ? low : high;
    return {nearer / (sigma * sigma), 1 / (sigma * sigma)};
  }
  const double mean = (density(a) - density(b)) / inside;
  const auto finite = [](double x) { return std::isfinite(x) ? x : 0; };
  const double spread = 1 + (finite(a * density(a)) - finite(b * density(b))) / inside - mean * mean;
  return {mean / sigma, std::clamp(1 - spread, 0.0, 1.0) / (sigma * sigma)};
}

RefinedPose fit_to_pixels(const OutlineMesh& mesh, const RefinedPose& start, const StencilEvidence& evidence,
                          const LensPrior& lens) {
  const int last = evidence.levels() - 1;
  const StencilLevel& level = evidence.at(last);
  const bool free_principal = !start.pose.principal.isZero();
  const Eigen::MatrixXd directions = free_directions(lens, free_principal);
  RefinedPose best = start;
  OutlinePose pose = start.pose;
  OutlineDrawing drawing;
  std::vector<RimResidual> residuals;
  for (std::size_t i = 0;; ++i) {
    drawing.draw(mesh, pose, level.window);
    const Agreement agreement = evidence.match(drawing, last, reach_px, inlier_px, residuals);
    if (agreement.overlap > best.agreement.overlap) {
      best.pose = pose;
      best.agreement = agreement;
    }
    if (i == sigmas_px.size()) break;
    NormalEquations sum = equations(drawing.crossings(mesh, pose), drawing, level, pose, sigmas_px[i]);
    add_priors(pose, lens, free_principal, sum);
    Eigen::MatrixXd matrix = directions.transpose() * sum.matrix * directions;
    matrix.diagonal() *= 1 + 1e-6;
    PoseVector step = directions * matrix.ldlt().solve(directions.transpose() * sum.vector);
    if (!step.allFinite()) break;
    const double turn = step.head<3>().norm();
    if (turn > most_turn_rad) step *= most_turn_rad / turn;
    pose = within_lens(moved(pose, step), lens);
  }
  return best;
}

}  // namespace drape::alignment
