#include "backdrop.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace drape::segmentation {
namespace {

constexpr int term_count = 6;
constexpr double border_width = 0.03;  // of the shorter side
constexpr int robust_rounds = 12;
constexpr int growing_rounds = 3;
constexpr int sheet_growing_rounds = 8;
constexpr std::size_t most_sheets = 3;
constexpr double least_sheet = 0.06;   // of the border: less is an object that reaches over it
constexpr float mode_width = 3;        // Lab units: how far from a sheet's commonest colour it is started,
constexpr float least_step = 2.5F;     // and how far its pixels may be off, or so far as its noise asks for
constexpr int seam_px = 2;             // between two sheets, where their colours mix
constexpr float least_difference = 6;  // Lab units, that an object differs from its backdrop by
constexpr float noise_multiple = 5;    // ... or so many deviations of the backdrop,
constexpr float most_difference = 25;  // but what varies by more than this is not smooth
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

float smooth_limit_of(const std::vector<float>& noise) {
  return std::min(most_difference, limit_of(noise));
}

/// One smooth part of a backdrop: the wall, the floor, the top of a table.
struct Sheet {
  Surface surface = Surface::Zero();
  float limit = least_difference;
  Mask grown;  // what hangs together with the border and looks like it
};

// The colour that most of the `open` pixels of the border are near to.
std::array<float, 3> commonest_color(const ImageF& lab, const Mask& open) {
  constexpr float bin = mode_width / 2;
  std::map<std::array<int, 3>, int> counts;
  for (int y = 0; y < lab.height(); ++y)
    for (int x = 0; x < lab.width(); ++x) {
      if (!open.at(x, y)) continue;
      std::array<int, 3> cell{};
      for (int c = 0; c < 3; ++c)
        cell[static_cast<std::size_t>(c)] = static_cast<int>(std::floor(lab.at(x, y, c) / bin));
      ++counts[cell];
    }
  const auto most = std::max_element(counts.begin(), counts.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  std::array<float, 3> color{};
  for (std::size_t c = 0; c < 3; ++c) color[c] = (static_cast<float>(most->first[c]) + 0.5F) * bin;
  return color;
}

// Started from the commonest colour of the `open` part of the border, and grown from there while the fit of
// what it has tells what comes next: a backdrop that falls off has no one colour.
Sheet sheet_of(const ImageF& lab, const Mask& open, const Mask& taken) {
  const std::array<float, 3> color = commonest_color(lab, open);
  Sheet sheet;
  sheet.grown = Mask(lab.width(), lab.height(), 1, 0);
  for (int y = 0; y < lab.height(); ++y)
    for (int x = 0; x < lab.width(); ++x)
      if (open.at(x, y))
        sheet.grown.at(x, y) = std::hypot(lab.at(x, y, 0) - color[0], lab.at(x, y, 1) - color[1],
                                          lab.at(x, y, 2) - color[2]) < mode_width;
  ImageF difference(lab.width(), lab.height(), 1);
  std::ptrdiff_t size = 0;
  for (int round = 0; round < sheet_growing_rounds; ++round) {
    sheet.surface = robust_fit(lab, sheet.grown);
    const std::vector<float> noise = residuals(sheet.surface, lab, sheet.grown);
    sheet.limit = smooth_limit_of(noise);
    const float step = std::max(least_step, noise_multiple * 1.4826F * median(noise));
    for (int y = 0; y < lab.height(); ++y)
      for (int x = 0; x < lab.width(); ++x)
        difference.at(x, y) =
            taken.at(x, y) ? std::numeric_limits<float>::max() : residual(sheet.surface, lab, x, y);
    sheet.grown = grown_from_border(difference, step);
    const std::ptrdiff_t now = std::count(sheet.grown.data().begin(), sheet.grown.data().end(), 1);
    if (now == 0 || std::abs(now - size) * 200 < now) break;
    size = now;
  }
  return sheet;
}

double share_of(const Mask& part, const Mask& whole) {
  return static_cast<double>(std::count(part.data().begin(), part.data().end(), 1)) /
         static_cast<double>(
             std::max<std::ptrdiff_t>(1, std::count(whole.data().begin(), whole.data().end(), 1)));
}

// Parts of the border that no sheet so far accounts for become the next one.
std::vector<Sheet> sheets_of(const ImageF& lab) {
  const Mask border = border_band(lab);
  Mask open = border;
  Mask taken(lab.width(), lab.height(), 1, 0);
  std::vector<Sheet> sheets;
  while (sheets.size() < most_sheets && share_of(open, border) > least_sheet) {
    Sheet sheet = sheet_of(lab, open, taken);
    Mask rest = open;
    for (std::size_t i = 0; i < rest.data().size(); ++i)
      if (sheet.grown.data()[i] != 0) {
        rest.data()[i] = 0;
        taken.data()[i] = 1;
      }
    if (share_of(open, border) - share_of(rest, border) < least_sheet) break;
    open = std::move(rest);
    sheets.push_back(std::move(sheet));
  }
  return sheets;
}

Mask widened(const Mask& mask, int reach) {
  Mask out(mask.width(), mask.height(), 1, 0);
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x) {
      if (!mask.at(x, y)) continue;
      for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx)
          if (out.contains(x + dx, y + dy)) out.at(x + dx, y + dy) = 1;
    }
  return out;
}

// How far a colour is from all mixtures of those that two sheets have there.
float seam_residual(const Sheet& a, const Sheet& b, const ImageF& lab, int x, int y) {
  const Terms at = terms(x, y, lab);
  const Eigen::RowVector3d from = at * a.surface;
  const Eigen::RowVector3d step = at * b.surface - from;
  const Eigen::RowVector3d here =
      Eigen::RowVector3d(lab.at(x, y, 0), lab.at(x, y, 1), lab.at(x, y, 2)) - from;
  const double along = std::clamp(here.dot(step) / std::max(step.squaredNorm(), 1e-9), 0.0, 1.0);
  return static_cast<float>((here - along * step).norm());
}

Backdrop backdrop_of(const std::vector<Sheet>& sheets, const ImageF& lab) {
  ImageF difference(lab.width(), lab.height(), 1);
  for (int y = 0; y < lab.height(); ++y)
    for (int x = 0; x < lab.width(); ++x) {
      float least = std::numeric_limits<float>::max();
      for (const Sheet& sheet : sheets)
        least = std::min(least, residual(sheet.surface, lab, x, y) / sheet.limit);
      difference.at(x, y) = least;
    }
  std::vector<Mask> wide;
  for (const Sheet& sheet : sheets) wide.push_back(widened(sheet.grown, seam_px));
  for (std::size_t a = 0; a < sheets.size(); ++a)
    for (std::size_t b = a + 1; b < sheets.size(); ++b)
      for (int y = 0; y < lab.height(); ++y)
        for (int x = 0; x < lab.width(); ++x)
          if (wide[a].at(x, y) && wide[b].at(x, y))
            difference.at(x, y) =
                std::min(difference.at(x, y), seam_residual(sheets[a], sheets[b], lab, x, y) /
                                                  std::max(sheets[a].limit, sheets[b].limit));
  Backdrop backdrop = in_units_of(1, std::move(difference));
  backdrop.sheets = sheets.size();
  return backdrop;
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
  Backdrop one = in_units_of(limit, std::move(difference));
  const std::vector<Sheet> sheets = sheets_of(lab);
  if (sheets.size() < 2) return one;
  Backdrop several = backdrop_of(sheets, lab);
  return several.border_share > one.border_share ? several : one;
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
