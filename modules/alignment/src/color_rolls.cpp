#include "color_rolls.hpp"

#include <algorithm>
#include <cmath>

#include "fast_popcount.hpp"

namespace drape::alignment {
namespace {

constexpr int table_size = 4096;
constexpr std::size_t most_colors = 32;

// k ln k.
const std::array<float, table_size + 1>& entropy_table() {
  static const auto table = [] {
    std::array<float, table_size + 1> values{};
    for (std::size_t k = 1; k < values.size(); ++k)
      values[k] = static_cast<float>(static_cast<double>(k) * std::log(static_cast<double>(k)));
    return values;
  }();
  return table;
}

float entropy_at(float steps) {
  return entropy_table()[static_cast<std::size_t>(
      std::clamp(steps + 0.5F, 0.F, static_cast<float>(table_size)))];
}

double x_log_x(double x) {
  return x > 0 ? x * std::log(x) : 0;
}

// Samples of each colour inside the view turned by every other roll, by the area that they stand for.
DRAPE_FAST_POPCOUNT
void count_rolls(std::span<const std::vector<ColorRolls::ColorBits>, polar_rings> rings,
                 const PolarBits& view, std::span<std::array<int, most_colors>, polar_angles / 2> counts) {
  for (auto& count : counts) count.fill(0);
  for (std::size_t i = 0; i < polar_rings; ++i) {
    if (view[i] == 0) continue;
    const int weight = 2 * static_cast<int>(i) + 1;
    if (view[i] == ~std::uint64_t{0}) {
      for (const ColorRolls::ColorBits& bits : rings[i]) {
        const int all = weight * __builtin_popcountll(bits.word);
        for (auto& count : counts) count[bits.color] += all;
      }
      continue;
    }
    for (std::size_t roll = 0; roll < counts.size(); ++roll) {
      const std::uint64_t turned = std::rotl(view[i], 2 * static_cast<int>(roll));
      for (const ColorRolls::ColorBits& bits : rings[i])
        counts[roll][bits.color] += weight * __builtin_popcountll(turned & bits.word);
    }
  }
}

// The outermost ring that the view reaches, in radii, towards each angle: its support function.
std::array<float, polar_angles> reach_of(const PolarBits& view) {
  std::array<float, polar_angles> radius{};
  std::uint64_t seen = 0;
  for (int i = polar_rings - 1; i >= 0; --i) {
    for (std::uint64_t rest = view[static_cast<std::size_t>(i)] & ~seen; rest != 0; rest &= rest - 1)
      radius[static_cast<std::size_t>(std::countr_zero(rest))] =
          static_cast<float>((i + 1) * polar_reach / polar_rings);
    seen |= view[static_cast<std::size_t>(i)];
  }
  static const auto cosines = [] {
    std::array<float, polar_angles> table{};
    for (std::size_t j = 0; j < table.size(); ++j)
      table[j] = static_cast<float>(std::cos(2 * std::numbers::pi * static_cast<double>(j) / polar_angles));
    return table;
  }();
  std::array<float, polar_angles> reach{};
  for (std::size_t a = 0; a < reach.size(); a += 2)
    for (std::size_t j = 0; j < radius.size(); ++j)
      reach[a] = std::max(reach[a], radius[j] * cosines[(j - a) & (polar_angles - 1)]);
  return reach;
}

}  // namespace

double uncertainty_coefficient(std::span<const double> inside, std::span<const double> all) {
  double in = 0;
  double total = 0;
  double left_open = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    in += inside[i];
    total += all[i];
    left_open += x_log_x(all[i]) - x_log_x(inside[i]) - x_log_x(all[i] - inside[i]);
  }
  const double open = x_log_x(total) - x_log_x(in) - x_log_x(total - in);
  return open > 0 ? std::clamp(1 - left_open / open, 0.0, 1.0) : 0;
}

ColorRolls::ColorRolls(const ColorLevel& level, const PolarFrame& frame, const ColorRegion& region)
    : region_(region), frame_(frame) {
  std::array<std::array<std::uint64_t, most_colors>, polar_rings> words{};
  if (level.labels.size() > most_colors) return;
  visit_polar(frame, [&](std::size_t ring, std::size_t angle, double x, double y) {
    const int px = static_cast<int>(std::floor(x));
    const int py = static_cast<int>(std::floor(y));
    if (!level.label_at.contains(px, py)) return;
    const std::uint8_t color = level.label_at.at(px, py);
    if (color != ColorLevel::no_label) words[ring][color] |= std::uint64_t{1} << angle;
  });
  const double step = polar_reach / polar_rings * frame.radius;
  const double pixels_per_count = step * step * std::numbers::pi / polar_angles;
  for (std::size_t c = 0; c < level.labels.size(); ++c) {
    float seen = 0;
    for (std::size_t i = 0; i < polar_rings; ++i) {
      if (words[i][c] == 0) continue;
      seen += static_cast<float>((2 * i + 1) * static_cast<std::size_t>(std::popcount(words[i][c])));
      rings_[i].push_back({words[i][c], all_.size()});
    }
    const float count =
        region.pixels.empty() ? seen : static_cast<float>(region.pixels[c] / pixels_per_count);
    total_ += count;
    if (seen > 0) all_.push_back(count);  // what no ring shows tells nothing
  }
  steps_per_count_ = total_ > 0 ? static_cast<float>(table_size) / total_ : 0;
  for (float& count : all_) {
    count *= steps_per_count_;
    constant_ += entropy_at(count);
  }
  if (region.click) {
    const Eigen::Vector2d offset = *region.click - frame.center;
    click_ring_ = static_cast<int>(offset.norm() / frame.radius * polar_rings / polar_reach);
    click_angle_ = static_cast<int>(std::lround(std::atan2(offset.y(), offset.x()) / (2 * std::numbers::pi) *
                                                polar_angles)) &
                   (polar_angles - 1);
  }
}

float ColorRolls::score_of(std::span<const int> inside) const {
  float in = 0;
  float left_open = constant_;
  for (std::size_t c = 0; c < all_.size(); ++c) {
    const float here = std::min(all_[c], static_cast<float>(inside[c]) * steps_per_count_);
    in += here;
    left_open -= entropy_at(here) + entropy_at(all_[c] - here);
  }
  const auto total = static_cast<float>(table_size);
  const float open = entropy_at(total) - entropy_at(in) - entropy_at(total - in);
  return open > 1 ? std::clamp(1 - left_open / open, 0.F, 1.F) : 0.F;
}

float ColorRolls::fit_of(std::span<const float, polar_angles> reach, int roll) const {
  const auto towards = [&](int angle) {
    return reach[static_cast<std::size_t>((angle - roll) & (polar_angles - 1))] *
           static_cast<float>(frame_.radius);
  };
  const Eigen::Vector2f center = frame_.center.cast<float>();
  return region_.fit(center - Eigen::Vector2f(towards(polar_angles / 2), towards(3 * polar_angles / 4)),
                     center + Eigen::Vector2f(towards(0), towards(polar_angles / 4)));
}

void ColorRolls::score(const PolarBits& view, std::span<float, polar_angles> scores) const {
  std::fill(scores.begin(), scores.end(), 0.F);
  if (!(total_ > 0)) return;
  if (click_ring_ >= polar_rings) return;
  std::array<std::array<int, most_colors>, polar_angles / 2> counts;
  count_rolls(rings_, view, counts);
  std::array<float, polar_angles> reach{};
  if (region_.fit) reach = reach_of(view);
  for (int roll = 0; roll < polar_angles; roll += 2) {
    float& score = scores[static_cast<std::size_t>(roll)];
    if (click_ring_ >= 0) {
      const std::uint64_t turned = std::rotl(view[static_cast<std::size_t>(click_ring_)], roll);
      if (((turned >> click_angle_) & 1U) == 0) continue;
    }
    score = score_of(std::span(counts[static_cast<std::size_t>(roll / 2)]).first(all_.size()));
    if (region_.fit) score *= fit_of(reach, roll);
  }
  for (std::size_t roll = 1; roll < scores.size(); roll += 2)
    scores[roll] = (scores[roll - 1] + scores[(roll + 1) % polar_angles]) / 2;
}

}  // namespace drape::alignment
