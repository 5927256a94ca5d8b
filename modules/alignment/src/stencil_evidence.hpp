// The photo's stencil as evidence.
#pragma once

#include <memory>
#include <vector>

#include "evidence.hpp"
#include "stencil_level.hpp"

namespace drape::alignment {

class StencilEvidence final : public Evidence {
 public:
  /// The stencil as align_photo takes it.
  StencilEvidence(const Image8& stencil, const PhotoPlane& plane);

  [[nodiscard]] int levels() const override { return static_cast<int>(levels_.size()); }
  [[nodiscard]] const Window& window(int level) const override { return at(level).window; }
  [[nodiscard]] std::vector<PolarFrame> frames(int effort) const override;
  [[nodiscard]] std::unique_ptr<RollScores> rolls(const PolarFrame& frame) const override;
  [[nodiscard]] const StencilLevel* outline() const override { return &levels_.front(); }
  [[nodiscard]] Agreement match(const OutlineDrawing& drawing, int level, double reach_px, double inlier_px,
                                std::vector<RimResidual>& residuals) const override;

  [[nodiscard]] const StencilLevel& at(int level) const { return levels_[static_cast<std::size_t>(level)]; }

 private:
  std::vector<StencilLevel> levels_;
};

}  // namespace drape::alignment
