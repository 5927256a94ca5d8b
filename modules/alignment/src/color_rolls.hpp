// How well a view of the mesh parts the photo's colours, for all of its rolls at once.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "color_level.hpp"
#include "evidence.hpp"

namespace drape::alignment {

/// Share of what "inside the outline or not" leaves open that the colours tell: the mutual information of
/// the two over the entropy of the first (Theil's uncertainty coefficient), 0..1. Plain mutual information
/// would rather part the table from the floor than the object from the table. `inside[i]` of the `all[i]`
/// pixels of colour i are inside.
[[nodiscard]] double uncertainty_coefficient(std::span<const double> inside, std::span<const double> all);

/// What the frames are compared over, and what the outline must do.
struct ColorRegion {
  /// Pixels of each colour in a region that is the same for all frames; empty: what the frame's rings reach.
  std::vector<double> pixels;
  /// Factor of the score for an outline that reaches from `least` to `most` (window pixels), 0..1; or none.
  std::function<float(const Eigen::Vector2f& least, const Eigen::Vector2f& most)> fit;
  /// In window pixels: must be inside.
  std::optional<Eigen::Vector2d> click;
};

/// Scores every other roll; those between have the mean of their neighbours, and are never best.
class ColorRolls final : public Evidence::RollScores {
 public:
  ColorRolls(const ColorLevel& level, const PolarFrame& frame, const ColorRegion& region);
  void score(const PolarBits& view, std::span<float, polar_angles> scores) const override;

  /// Where a ring shows a colour, which is one of those that some ring shows.
  struct ColorBits {
    std::uint64_t word = 0;
    std::size_t color = 0;
  };

 private:
  [[nodiscard]] float score_of(std::span<const int> inside) const;
  [[nodiscard]] float fit_of(std::span<const float, polar_angles> reach, int roll) const;

  const ColorRegion& region_;
  PolarFrame frame_;
  std::array<std::vector<ColorBits>, polar_rings> rings_;  // no empty words
  std::vector<float> all_;  // of each colour, in steps of the logarithms' table
  float steps_per_count_ = 1;
  float constant_ = 0;  // the parts of the score that no view changes
  float total_ = 0;
  int click_ring_ = -1;
  int click_angle_ = 0;
};

}  // namespace drape::alignment
