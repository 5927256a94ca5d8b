#include "color_model.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

namespace drape::alignment {
namespace {

constexpr float most_log_ratio = 3;
constexpr float prior_share = 2e-5F;  // of every bin, in either histogram
constexpr std::size_t sectors = 12;   // about the object's middle, each with histograms of its own
constexpr float local_share = 0.5F;   // of the colours close by, against those all round
constexpr double correlation_px = 3;  // neighbouring pixels along a line are not independent
constexpr double flat_step = 4;       // Lab units: steps of texture and noise, which tell nothing

using Histogram = std::vector<float>;

// By (1 2 1) / 4 along each of the three axes.
void smooth(Histogram& histogram) {
  Histogram before(histogram.size());
  for (const std::size_t stride : {std::size_t{256}, std::size_t{16}, std::size_t{1}}) {
    before.swap(histogram);
    for (std::size_t first = 0; first < before.size(); first += 16 * stride)
      for (std::size_t step = 0; step < 16; ++step) {
        const float* here = before.data() + first + step * stride;
        const float* below = step > 0 ? here - stride : here;
        const float* above = step < 15 ? here + stride : here;
        float* out = histogram.data() + first + step * stride;
        for (std::size_t i = 0; i < stride; ++i)
          out[i] = 0.25F * below[i] + 0.5F * here[i] + 0.25F * above[i];
      }
  }
}

float sum_of(const Histogram& histogram) {
  float sum = 0;
  for (const float value : histogram) sum += value;
  return sum;
}

// Of colour, in Lab units.
float step_along(const ColorLevel& level, int x, int y, const Eigen::Vector2d& direction) {
  if (!level.steps.contains(x, y)) return 0;
  const ColorLevel::Step& step = level.steps.at(x, y);
  const auto nx = static_cast<float>(direction.x());
  const auto ny = static_cast<float>(direction.y());
  return std::sqrt(std::max(0.F, step.xx * nx * nx + 2 * step.xy * nx * ny + step.yy * ny * ny));
}

}  // namespace

PixelRegion region_about(const BitImage& stencil, double share) {
  PixelRegion box{stencil.width(), stencil.height(), 0, 0};
  for (int y = 0; y < stencil.height(); ++y) {
    const std::span<const std::uint64_t> row = stencil.row(y);
    const auto set = [](std::uint64_t word) { return word != 0; };
    const auto first = std::find_if(row.begin(), row.end(), set);
    if (first == row.end()) continue;
    const auto last = std::find_if(row.rbegin(), row.rend(), set);
    box.left = std::min(box.left, static_cast<int>(64 * (first - row.begin())) + std::countr_zero(*first));
    box.right = std::max(box.right, static_cast<int>(64 * (row.rend() - last)) - std::countl_zero(*last));
    box.top = std::min(box.top, y);
    box.bottom = y + 1;
  }
  if (box.right <= box.left) return {};
  const int more = static_cast<int>(share * std::max(box.right - box.left, box.bottom - box.top)) + 2;
  return {std::max(0, box.left - more), std::max(0, box.top - more),
          std::min(stencil.width(), box.right + more), std::min(stencil.height(), box.bottom + more)};
}

ColorModel::ColorModel(const ColorLevel& level, const BitImage& stencil, const PixelRegion& around,
                       bool local)
    : bins_(&level.bins) {
  middle_ = Eigen::Vector2d(around.left + around.right, around.top + around.bottom) / 2;
  const std::size_t parts = local ? sectors : 1;
  std::vector<Histogram> inside(parts, Histogram(ColorLevel::bin_count, 0));
  std::vector<Histogram> outside = inside;
  sector_count_ = parts;
  for (int y = around.top; y < around.bottom; ++y) {
    const std::span<const std::uint64_t> row = stencil.row(y);
    for (int x = around.left; x < around.right; ++x) {
      const std::uint16_t bin = level.bins.at(x, y);
      if (bin == ColorLevel::no_bin) continue;
      const bool in = ((row[static_cast<std::size_t>(x >> 6)] >> (x & 63)) & 1U) != 0;
      const std::size_t sector = sector_of({x + 0.5, y + 0.5});
      ++(in ? inside : outside)[sector][bin];
    }
  }
  if (level.smooth) {
    for (Histogram& h : inside) smooth(h);
    for (Histogram& h : outside) smooth(h);
  }
  Histogram all_inside(ColorLevel::bin_count, 0);
  Histogram all_outside(ColorLevel::bin_count, 0);
  for (std::size_t s = 0; s < parts; ++s)
    for (std::size_t i = 0; i < all_inside.size(); ++i) {
      all_inside[i] += inside[s][i];
      all_outside[i] += outside[s][i];
    }
  const float inside_total = sum_of(all_inside);
  const float outside_total = sum_of(all_outside);
  log_ratios_.assign(parts, std::vector<float>(ColorLevel::bin_count, 0));
  if (!(inside_total > 0) || !(outside_total > 0)) return;
  for (std::size_t s = 0; s < parts; ++s) {
    const std::size_t before = (s + parts - 1) % parts;
    const std::size_t after = (s + 1) % parts;
    const auto mixed = [&](const std::vector<Histogram>& part, const Histogram& all, float total,
                           float local_total, std::size_t i) {
      const float whole = all[i] / total;
      if (parts == 1 || !(local_total > 0)) return whole;
      const float near = (part[before][i] + 2 * part[s][i] + part[after][i]) / local_total;
      return (1 - local_share) * whole + local_share * near;
    };
    const float inside_near = sum_of(inside[before]) + 2 * sum_of(inside[s]) + sum_of(inside[after]);
    const float outside_near = sum_of(outside[before]) + 2 * sum_of(outside[s]) + sum_of(outside[after]);
    for (std::size_t i = 0; i < ColorLevel::bin_count; ++i) {
      if (all_inside[i] + all_outside[i] == 0) continue;
      const float ratio = (mixed(inside, all_inside, inside_total, inside_near, i) + prior_share) /
                          (mixed(outside, all_outside, outside_total, outside_near, i) + prior_share);
      log_ratios_[s][i] = std::clamp(std::log(ratio), -most_log_ratio, most_log_ratio);
    }
  }
}

std::size_t ColorModel::sector_of(const Eigen::Vector2d& at) const {
  if (sector_count_ == 1) return 0;
  const double turn = std::atan2(at.y() - middle_.y(), at.x() - middle_.x()) / (2 * std::numbers::pi) + 0.5;
  return std::min(sector_count_ - 1, static_cast<std::size_t>(turn * static_cast<double>(sector_count_)));
}

RimStep rim_step(const ColorLevel& level, const ColorModel& model, const RimSample& sample, int reach_px) {
  constexpr int most_reach = 32;
  const int reach = std::min(reach_px, most_reach);
  // Before the pixel at -reach, before the next, ...: the step lies half a pixel before each.
  std::array<float, 2 * most_reach + 2> sums{};
  std::array<float, 2 * most_reach + 2> steps{};
  float best = 0;
  const std::size_t sector = model.sector_of(sample.at);
  for (int i = 0; i <= 2 * reach; ++i) {
    const Eigen::Vector2d at = sample.at + (i - reach) * sample.outward;
    const int x = static_cast<int>(std::floor(at.x()));
    const int y = static_cast<int>(std::floor(at.y()));
    const float ratio = model.log_ratio(x, y, sector);
    const float step = step_along(level, x, y, sample.outward);
    steps[static_cast<std::size_t>(i)] += step;
    steps[static_cast<std::size_t>(i + 1)] += step;
    const auto next = static_cast<std::size_t>(i + 1);
    sums[next] = sums[next - 1] + ratio;
    best = std::max(best, sums[next]);
  }
  double weights = 0;
  double mean = 0;
  double squares = 0;
  for (int i = 0; i <= 2 * reach + 1; ++i) {
    const double weight = std::exp((sums[static_cast<std::size_t>(i)] - best) / correlation_px) *
                          (flat_step + static_cast<double>(steps[static_cast<std::size_t>(i)]) / 2);
    const double at = i - reach - 0.5;
    weights += weight;
    mean += weight * at;
    squares += weight * at * at;
  }
  mean /= weights;
  return {mean, std::max(0.0, squares / weights - mean * mean)};
}

double edge_step(const ColorLevel& level, const RimSample& sample, int reach_px) {
  float best = 0;
  for (int i = -reach_px; i <= reach_px; ++i) {
    const Eigen::Vector2d at = sample.at + i * sample.outward;
    best = std::max(best, step_along(level, static_cast<int>(std::floor(at.x())),
                                     static_cast<int>(std::floor(at.y())), sample.outward));
  }
  return best;
}

}  // namespace drape::alignment
