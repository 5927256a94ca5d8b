#include "surface_light.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

namespace drape::alignment {
namespace {

constexpr int least_pixels = 200;
constexpr double least_sigma = 0.004;  // of brightness: what eight bits leave
constexpr double kernel_deviations = 3;
constexpr int reweightings = 3;
constexpr double ridge = 1e-4;  // per pixel, of the light's coefficients
// Light that no harmonics describe, gloss and shadows go with the shape: more samples do not make them
// smaller.
constexpr double most_independent = 300;
constexpr int most_lag = 16;
constexpr double faded = 0.1;

double sigma_of(const std::vector<double>& residuals) {
  std::vector<double> sorted;
  sorted.reserve(residuals.size());
  for (const double r : residuals) sorted.push_back(std::abs(r));
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return std::max(least_sigma, 1.4826 * *middle);
}

// What a view shows in a light.
class Shown {
 public:
  Shown(const std::vector<SurfacePixel>& view, const Window& window, const LightTerms& light)
      : window_(window), values_(view.size()) {
    for (std::size_t p = 0; p < view.size(); ++p)
      if (view[p].seen)
        values_[p] = static_cast<double>(view[p].brightness) *
                     light_harmonics(view[p].normal.cast<double>()).dot(light);
  }

  /// Over `step` pixels to each side, as far as the surface is seen there.
  [[nodiscard]] Eigen::Vector2d slope(int x, int y, int step) const {
    return {slope(at(x - step, y), at(x, y), at(x + step, y), step),
            slope(at(x, y - step), at(x, y), at(x, y + step), step)};
  }

 private:
  [[nodiscard]] std::optional<double> at(int x, int y) const {
    if (x < 0 || y < 0 || x >= window_.width || y >= window_.height) return std::nullopt;
    return values_[static_cast<std::size_t>(y) * static_cast<std::size_t>(window_.width) +
                   static_cast<std::size_t>(x)];
  }
  static double slope(std::optional<double> before, std::optional<double> here, std::optional<double> after,
                      int step) {
    const int steps = (before ? 1 : 0) + (after ? 1 : 0);
    return steps == 0 ? 0 : (after.value_or(*here) - before.value_or(*here)) / (steps * step);
  }

  const Window& window_;
  std::vector<std::optional<double>> values_;
};

}  // namespace

LightTerms light_harmonics(const Eigen::Vector3d& normal) {
  const double x = normal.x();
  const double y = normal.y();
  const double z = normal.z();
  LightTerms h;
  h << 1, x, y, z, x * y, y * z, z * x, x * x - y * y, 3 * z * z - 1, y * (3 * x * x - y * y), x * y * z,
      y * (5 * z * z - 1), z * (5 * z * z - 3), x * (5 * z * z - 1), z * (x * x - y * y),
      x * (x * x - 3 * y * y);
  return h;
}

Eigen::Vector3d light_gradient(const Eigen::Vector3d& n, const LightTerms& c) {
  const double x = n.x();
  const double y = n.y();
  const double z = n.z();
  Eigen::Vector3d gradient;
  gradient.x() = c[1] + c[4] * y + c[6] * z + 2 * c[7] * x + 6 * c[9] * x * y + c[10] * y * z +
                 c[13] * (5 * z * z - 1) + 2 * c[14] * x * z + c[15] * (3 * x * x - 3 * y * y);
  gradient.y() = c[2] + c[4] * x + c[5] * z - 2 * c[7] * y + c[9] * (3 * x * x - 3 * y * y) + c[10] * x * z +
                 c[11] * (5 * z * z - 1) - 2 * c[14] * y * z - 6 * c[15] * x * y;
  gradient.z() = c[3] + c[5] * y + c[6] * x + 6 * c[8] * z + c[10] * x * y + 10 * c[11] * y * z +
                 c[12] * (15 * z * z - 3) + 10 * c[13] * x * z + c[14] * (x * x - y * y);
  return gradient;
}

SurfaceLight::SurfaceLight(const std::vector<SurfacePixel>& view, int width,
                           const std::vector<float>& brightness, const std::vector<std::uint8_t>& counts) {
  for (std::size_t p = 0; p < view.size(); ++p) {
    if (!view[p].seen || counts[p] == 0) continue;
    pixels_.push_back(p);
    looks_.emplace_back(static_cast<double>(view[p].brightness) *
                        light_harmonics(view[p].normal.cast<double>()));
  }
  if (!sees_enough()) return;
  solve(brightness);
  find_area(width);
}

bool SurfaceLight::sees_enough() const {
  return pixels_.size() >= least_pixels;
}

ShadingFit SurfaceLight::fit() const {
  ShadingFit fit;
  fit.sigma = sigma_;
  fit.pixels = static_cast<double>(pixels_.size());
  fit.independent = std::min(most_independent, fit.pixels / area_);
  double left = 0;
  for (const double r : residuals_) left += std::min(r * r, 9 * sigma_ * sigma_);
  fit.rms = std::sqrt(left / std::max(1.0, fit.pixels));
  fit.explained = spread_ > 0 ? std::clamp(1 - left / spread_, 0.0, 1.0) : 0.0;
  return fit;
}

void SurfaceLight::solve(const std::vector<float>& brightness) {
  const auto count = static_cast<double>(pixels_.size());
  weights_.assign(pixels_.size(), 1);
  residuals_.resize(pixels_.size());
  double sum = 0;
  double squares = 0;
  for (const std::size_t p : pixels_) {
    sum += static_cast<double>(brightness[p]);
    squares += static_cast<double>(brightness[p]) * static_cast<double>(brightness[p]);
  }
  spread_ = squares - sum * sum / count;
  for (int round = 0; round <= reweightings; ++round) {
    matrix_ = Eigen::Matrix<double, light_terms, light_terms>::Identity() * (ridge * count);
    matrix_(0, 0) = 1e-9 * count;
    LightTerms vector = LightTerms::Zero();
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      matrix_.selfadjointView<Eigen::Lower>().rankUpdate(looks_[i], weights_[i]);
      vector += weights_[i] * static_cast<double>(brightness[pixels_[i]]) * looks_[i];
    }
    matrix_ = Eigen::Matrix<double, light_terms, light_terms>(matrix_.selfadjointView<Eigen::Lower>());
    coefficients_ = matrix_.ldlt().solve(vector);
    for (std::size_t i = 0; i < pixels_.size(); ++i)
      residuals_[i] = static_cast<double>(brightness[pixels_[i]]) - looks_[i].dot(coefficients_);
    sigma_ = sigma_of(residuals_);
    const double kernel = kernel_deviations * kernel_deviations * sigma_ * sigma_;
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      const double k = kernel / (kernel + residuals_[i] * residuals_[i]);
      weights_[i] = k * k;
    }
  }
}

// By the autocorrelation along rows and columns, up to where it has faded.
void SurfaceLight::find_area(int width) {
  std::vector<std::int32_t> number;
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    if (number.size() <= pixels_[i]) number.resize(pixels_[i] + 1, -1);
    number[pixels_[i]] = static_cast<std::int32_t>(i);
  }
  const auto clipped = [&](std::size_t i) { return std::clamp(residuals_[i], -3 * sigma_, 3 * sigma_); };
  double variance = 0;
  for (std::size_t i = 0; i < pixels_.size(); ++i) variance += clipped(i) * clipped(i);
  variance /= static_cast<double>(pixels_.size());
  area_ = 1;
  for (const std::size_t stride : {std::size_t{1}, static_cast<std::size_t>(width)}) {
    double length = 1;
    for (int lag = 1; lag <= most_lag; ++lag) {
      double products = 0;
      double count = 0;
      for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const std::size_t other = pixels_[i] + static_cast<std::size_t>(lag) * stride;
        if (other >= number.size() || number[other] < 0) continue;
        products += clipped(i) * clipped(static_cast<std::size_t>(number[other]));
        count += 1;
      }
      const double correlation = count > 0 && variance > 0 ? products / count / variance : 0;
      if (correlation < faded) break;
      length += 2 * correlation;
    }
    area_ *= length;
  }
}

Eigen::MatrixXd brightness_changes(const std::vector<SurfacePixel>& view, const Window& window,
                                   const OutlinePose& pose, const std::vector<std::size_t>& pixels,
                                   const LightTerms& coefficients, int step_px) {
  const Shown shown(view, window, coefficients);
  Eigen::MatrixXd changes(static_cast<Eigen::Index>(pixels.size()), pose_parameters);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const SurfacePixel& pixel = view[pixels[i]];
    const int x = static_cast<int>(pixels[i]) % window.width;
    const int y = static_cast<int>(pixels[i]) / window.width;
    const Eigen::Vector2d place = window.to_photo(Eigen::Vector2d(x + 0.5, y + 0.5)) - pose.principal;
    const double depth = static_cast<double>(pixel.depth);
    Eigen::Vector3d turned;
    turned << (place * (1 + pose.perspective * depth) - pose.shift) / pose.scale, depth;
    PoseVector change = -window.px_per_photo_px * place_derivative(pose, turned, shown.slope(x, y, step_px));
    const Eigen::Vector3d normal = pixel.normal.cast<double>();
    change.head<3>() +=
        static_cast<double>(pixel.brightness) * normal.cross(light_gradient(normal, coefficients));
    changes.row(static_cast<Eigen::Index>(i)) = change;
  }
  return changes;
}

}  // namespace drape::alignment
