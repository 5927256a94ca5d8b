// What colours the object and its surroundings have, given about where it is.
#pragma once

#include <vector>

#include "color_level.hpp"
#include "evidence.hpp"

namespace drape::alignment {

/// Window pixels; right and bottom exclusive.
struct PixelRegion {
  int left = 0, top = 0, right = 0, bottom = 0;
};

/// The box of what is drawn, grown by `share` of its longer side on each side, within the window.
[[nodiscard]] PixelRegion region_about(const BitImage& stencil, double share);

/// Smoothed histograms of the colours inside a stencil and around it; with `local`, half of their weight is
/// that of the colours in the same direction from the middle (after the local histograms of Tjaden et al.,
/// PAMI 2018).
class ColorModel {
 public:
  ColorModel(const ColorLevel& level, const BitImage& stencil, const PixelRegion& around, bool local);

  /// Which of the local histograms counts at a place (window pixels).
  [[nodiscard]] std::size_t sector_of(const Eigen::Vector2d& at) const;

  /// Log of how much likelier the pixel's colour is inside, within -most..most; 0 outside the photo.
  [[nodiscard]] float log_ratio(int x, int y, std::size_t sector) const {
    if (!bins_->contains(x, y)) return 0;
    const std::uint16_t bin = bins_->at(x, y);
    return bin == ColorLevel::no_bin ? 0 : log_ratios_[sector][bin];
  }

 private:
  const Image<std::uint16_t>* bins_;
  std::size_t sector_count_ = 1;
  Eigen::Vector2d middle_ = Eigen::Vector2d::Zero();
  std::vector<std::vector<float>> log_ratios_;  // of each sector
};

/// Where along a rim sample's normal the colours change from the object's to the surroundings'. After Tjaden
/// et al. (PAMI 2018) and Stoiber et al. (2022): of all places within the reach, the posterior of a step
/// there given the colours along the line, times how large the step of colour there is.
struct RimStep {
  double distance_px = 0;  // mean of the posterior, outward
  double variance_px2 = 0;
};
[[nodiscard]] RimStep rim_step(const ColorLevel& level, const ColorModel& model, const RimSample& sample,
                               int reach_px);

/// The largest step of colour (Lab units) along the sample's normal within `reach_px`.
[[nodiscard]] double edge_step(const ColorLevel& level, const RimSample& sample, int reach_px);

}  // namespace drape::alignment
