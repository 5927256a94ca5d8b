#include "backdrop.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace drape::segmentation {
namespace {

constexpr int term_count = 6;
constexpr double border_width = 0.03;  // of the shorter side
constexpr int robust_rounds = 12;
constexpr int growing_rounds = 3;
constexpr float least_difference = 6;  // Lab units, that an object differs from its backdrop by
constexpr float noise_multiple = 5;    // ... or so many deviations of the backdrop
constexpr float shadow_weight = 0.6F;  // of a backdrop that is only darker: an object's shadow on it

using Terms = Eigen::Matrix<double, 1, term_count>;
using Surface = Eigen::Matrix<double, term_count, 3>;  // L, a, b of the position
using Mask = Image<std::uint8_t>;

Terms terms(int x, int y, const ImageF& lab) {
  const double u = (2.0 * x + 1) / lab.width() - 1;
  const double v = (2.0 * y + 1) / lab.height() - 1;
  Terms row;
  row << 1, u, v, u * u, u * v, v * v;
  return row;
}

float residual(const Surface& surface, const ImageF& lab, int x, int y) {
  const Eigen::Matrix<float, 1, 3> fit = (terms(x, y, lab) * surface).cast<float>();
  float lightness = lab.at(x, y, 0) - fit[0];
  if (lightness < 0) lightness *= shadow_weight;
  return std::hypot(lightness, lab.at(x, y, 1) - fit[1], lab.at(x, y, 2) - fit[2]);
}

float median(std::vector<float> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<float> residuals(const Surface& surface, const ImageF& lab, const Mask& used) {
  std::vector<float> out;
  for (int y = 0; y < lab.height(); ++y)
    for (int x = 0; x < lab.width(); ++x)
      if (used.at(x, y)) out.push_back(residual(surface, lab, x, y));
  return out;
}

// Weighted least squares; the weights of Cauchy's loss, from the fit before.
Surface fitted(const Surface& before, bool first, float scale, const ImageF& lab, const Mask& used) {
  Eigen::Matrix<double, term_count, term_count> normal;
  normal.setIdentity();
  normal *= 1e-6;
  Surface right = Surface::Zero();
  for (int y = 0; y < lab.height(); ++y)
    for (int x = 0; x < lab.width(); ++x) {
      if (!used.at(x, y)) continue;
      const double r = first ? 0 : static_cast<double>(residual(before, lab, x, y) / scale);
      const double weight = 1 / (1 + r * r);
      const Terms row = terms(x, y, lab);
      normal += weight * row.transpose() * row;
      right +=
          weight * row.transpose() * Eigen::RowVector3d(lab.at(x, y, 0), lab.at(x, y, 1), lab.at(x, y, 2));
    }
  return normal.ldlt().solve(right);
}

Surface robust_fit(const ImageF& lab, const Mask& used) {
  Surface surface = fitted({}, true, 1, lab, used);
  for (int round = 0; round < robust_rounds; ++round) {
    const float scale = std::max(1.F, 1.5F * median(residuals(surface, lab, used)));
    surface = fitted(surface, false, scale, lab, used);
  }
  return surface;
}

int border_pixels(const ImageF& lab) {
  return std::max(1, static_cast<int>(border_width * std::min(lab.width(), lab.height())));
}

Mask border_band(const ImageF& lab) {
  const int width = border_pixels(lab);
  Mask band(lab.width(), lab.height(), 1, 0);
  for (int y = 0; y < lab.height(); ++y)
    for (int x = 0; x < lab.width(); ++x)
      if (std::min({x, y, lab.width() - 1 - x, lab.height() - 1 - y}) < width) band.at(x, y) = 1;
  return band;
}

// The pixels under the limit that hang together with such pixels of the border.
Mask grown_from_border(const ImageF& difference, float limit) {
  Mask grown(difference.width(), difference.height(), 1, 0);
  std::vector<std::pair<int, int>> open;
  const auto visit = [&](int x, int y) {
    if (!grown.contains(x, y) || grown.at(x, y) || difference.at(x, y) >= limit) return;
    grown.at(x, y) = 1;
    open.emplace_back(x, y);
  };
  for (int x = 0; x < grown.width(); ++x) {
    visit(x, 0);
    visit(x, grown.height() - 1);
  }
  for (int y = 0; y < grown.height(); ++y) {
    visit(0, y);
    visit(grown.width() - 1, y);
  }
  while (!open.empty()) {
    const auto [x, y] = open.back();
    open.pop_back();
    visit(x - 1, y);
    visit(x + 1, y);
    visit(x, y - 1);
    visit(x, y + 1);
  }
  return grown;
}

double border_share(const ImageF& difference) {
  double inside = 0;
  double all = 0;
  for (int y = 0; y < difference.height(); ++y)
    for (int x = 0; x < difference.width(); ++x) {
      if (x > 0 && y > 0 && x + 1 < difference.width() && y + 1 < difference.height()) continue;
      all += 1;
      if (difference.at(x, y) < 1) inside += 1;
    }
  return inside / all;
}

// Differences in units of the limit between backdrop and object.
Backdrop in_units_of(float limit, ImageF difference) {
  for (float& value : difference.data()) value /= limit;
  Backdrop backdrop;
  backdrop.border_share = border_share(difference);
  backdrop.difference = std::move(difference);
  return backdrop;
}

float limit_of(const std::vector<float>& noise) {
  return std::max(least_difference, noise_multiple * 1.4826F * median(noise));
}

}  // namespace

Backdrop smooth_backdrop(const ImageF& lab) {
  Mask used = border_band(lab);
  ImageF difference(lab.width(), lab.height(), 1);
  float limit = least_difference;
  for (int round = 0; round < growing_rounds; ++round) {
    const Surface surface = robust_fit(lab, used);
    limit = limit_of(residuals(surface, lab, used));
    for (int y = 0; y < lab.height(); ++y)
      for (int x = 0; x < lab.width(); ++x) difference.at(x, y) = residual(surface, lab, x, y);
    used = grown_from_border(difference, limit);
    if (std::find(used.data().begin(), used.data().end(), 1) == used.data().end()) break;
  }
  return in_units_of(limit, std::move(difference));
}

Backdrop photographed_backdrop(const ImageF& lab, const ImageF& empty_scene) {
  // Most of the picture shows the scene in both: the median ratio is that of the exposures.
  std::vector<float> ratios;
  for (std::size_t i = 0; i < lab.data().size(); i += 3)
    if (empty_scene.data()[i] > 5) ratios.push_back(lab.data()[i] / empty_scene.data()[i]);
  const float exposure = ratios.empty() ? 1.F : median(ratios);
  ImageF difference(lab.width(), lab.height(), 1);
  for (std::size_t i = 0; i < difference.data().size(); ++i) {
    const float* now = &lab.data()[3 * i];
    const float* empty = &empty_scene.data()[3 * i];
    float lightness = now[0] - exposure * empty[0];
    if (lightness < 0) lightness *= shadow_weight;
    difference.data()[i] = std::hypot(lightness, now[1] - empty[1], now[2] - empty[2]);
  }
  const float limit = limit_of(difference.data());
  return in_units_of(limit, std::move(difference));
}

}  // namespace drape::segmentation
