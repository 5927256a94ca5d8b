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
constexpr double most_samples = 6000;  // of the pixels that a sheet is fitted to
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
constexpr float least_shade = 0.25F;   // of the backdrop's lightness, in its shadow
constexpr float most_tint = 8;         // Lab units, between the colour of the sky and that of a lamp

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

/// A pixel that a backdrop is fitted to.
struct Sample {
  Terms terms;
  Eigen::Matrix<float, 1, 3> lab;
};

float residual(const Surface& surface, const Sample& sample) {
  const Eigen::Matrix<float, 1, 3> off = sample.lab - (sample.terms * surface).cast<float>();
  const float lightness = off[0] < 0 ? shadow_weight * off[0] : off[0];
  return std::hypot(lightness, off[1], off[2]);
}

Sample sample_of(const ImageF& lab, int x, int y) {
  return {terms(x, y, lab), {lab.at(x, y, 0), lab.at(x, y, 1), lab.at(x, y, 2)}};
}

float residual(const Surface& surface, const ImageF& lab, int x, int y) {
  return residual(surface, sample_of(lab, x, y));
}

// Six terms need no more of the pixels than some, taken evenly.
std::vector<Sample> samples_of(const ImageF& lab, const Mask& used) {
  const auto count = static_cast<std::size_t>(std::count(used.data().begin(), used.data().end(), 1));
  const double step = std::max(1.0, static_cast<double>(count) / most_samples);
  std::vector<Sample> samples;
  std::size_t seen = 0;
  for (int y = 0; y < lab.height(); ++y)
    for (int x = 0; x < lab.width(); ++x)
      if (used.at(x, y) && static_cast<double>(seen++) >= step * static_cast<double>(samples.size()))
        samples.push_back(sample_of(lab, x, y));
  return samples;
}

float median(std::vector<float> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<float> residuals(const Surface& surface, const std::vector<Sample>& samples) {
  std::vector<float> out;
  for (const Sample& sample : samples) out.push_back(residual(surface, sample));
  return out;
}

// Weighted least squares; the weights of Cauchy's loss, from the residuals of the fit before.
Surface fitted(const std::vector<float>& before, float scale, const std::vector<Sample>& samples) {
  Eigen::Matrix<double, term_count, term_count> normal;
  normal.setIdentity();
  normal *= 1e-6;
  Surface right = Surface::Zero();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double r = before.empty() ? 0 : static_cast<double>(before[i] / scale);
    const double weight = 1 / (1 + r * r);
    const Terms& row = samples[i].terms;
    normal += weight * row.transpose() * row;
    right += weight * row.transpose() * samples[i].lab.cast<double>();
  }
  return normal.ldlt().solve(right);
}

Surface robust_fit(const std::vector<Sample>& samples) {
  Surface surface = fitted({}, 1, samples);
  for (int round = 0; round < robust_rounds; ++round) {
    const std::vector<float> before = residuals(surface, samples);
    surface = fitted(before, std::max(1.F, 1.5F * median(before)), samples);
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

// Whether a colour may be that of `lit` in shadow: darker, and its colourfulness falls with its lightness.
bool in_shade(const float* lab, const Eigen::Matrix<float, 1, 3>& lit) {
  const float shade = lab[0] / std::max(lit[0], 1.F);
  return shade < 1 && shade > least_shade &&
         std::hypot(lab[1] - shade * lit[1], lab[2] - shade * lit[2]) < most_tint;
}

// Standard deviation of each of three channels, from the lengths of the three: their median is so many of it
// (of the chi distribution with three degrees of freedom).
float noise_of(const std::vector<float>& residuals) {
  return median(residuals) / 1.538F;
}

float limit_of(const std::vector<float>& noise) {
  return std::max(least_difference, noise_multiple * noise_of(noise));
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
    const std::vector<Sample> samples = samples_of(lab, sheet.grown);
    sheet.surface = robust_fit(samples);
    const std::vector<float> noise = residuals(sheet.surface, samples);
    sheet.limit = smooth_limit_of(noise);
    const float step = std::max(least_step, noise_multiple * noise_of(noise));
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
  Backdrop backdrop;
  backdrop.sheets = sheets.size();
  for (const Sheet& sheet : sheets) backdrop.limit = std::max(backdrop.limit, sheet.limit);
  ImageF& difference = backdrop.difference = ImageF(lab.width(), lab.height(), 1);
  backdrop.darker = Mask(lab.width(), lab.height(), 1, 0);
  for (int y = 0; y < lab.height(); ++y)
    for (int x = 0; x < lab.width(); ++x) {
      const Sample here = sample_of(lab, x, y);
      float least = std::numeric_limits<float>::max();
      for (const Sheet& sheet : sheets) {
        least = std::min(least, residual(sheet.surface, here) / sheet.limit);
        if (in_shade(&lab.at(x, y), (here.terms * sheet.surface).cast<float>())) backdrop.darker.at(x, y) = 1;
      }
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
  backdrop.border_share = border_share(difference);
  return backdrop;
}

// All of the border as one sheet, whatever parts it has.
Sheet sheet_of_border(const ImageF& lab) {
  Sheet sheet;
  sheet.grown = border_band(lab);
  ImageF difference(lab.width(), lab.height(), 1);
  for (int round = 0; round < growing_rounds; ++round) {
    const std::vector<Sample> samples = samples_of(lab, sheet.grown);
    sheet.surface = robust_fit(samples);
    const float limit = limit_of(residuals(sheet.surface, samples));
    // What has been grown over may be the object: the border alone tells the noise.
    sheet.limit = round == 0 ? limit : std::min(sheet.limit, limit);
    for (int y = 0; y < lab.height(); ++y)
      for (int x = 0; x < lab.width(); ++x) difference.at(x, y) = residual(sheet.surface, lab, x, y);
    sheet.grown = grown_from_border(difference, sheet.limit);
    if (std::find(sheet.grown.data().begin(), sheet.grown.data().end(), 1) == sheet.grown.data().end()) break;
  }
  return sheet;
}

}  // namespace

Backdrop smooth_backdrop(const ImageF& lab) {
  Backdrop one = backdrop_of({sheet_of_border(lab)}, lab);
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
  Backdrop backdrop;
  ImageF& difference = backdrop.difference = ImageF(lab.width(), lab.height(), 1);
  backdrop.darker = Mask(lab.width(), lab.height(), 1, 0);
  for (std::size_t i = 0; i < difference.data().size(); ++i) {
    const float* now = &lab.data()[3 * i];
    const float* empty = &empty_scene.data()[3 * i];
    const Eigen::Matrix<float, 1, 3> lit(exposure * empty[0], empty[1], empty[2]);
    float lightness = now[0] - lit[0];
    if (lightness < 0) lightness *= shadow_weight;
    difference.data()[i] = std::hypot(lightness, now[1] - lit[1], now[2] - lit[2]);
    backdrop.darker.data()[i] = in_shade(now, lit) ? 1 : 0;
  }
  const float limit = limit_of(difference.data());
  for (float& value : difference.data()) value /= limit;
  backdrop.border_share = border_share(difference);
  return backdrop;
}

}  // namespace drape::segmentation
