// The photo's stencil as evidence.
#pragma once

#include <memory>
#include <vector>

#include "evidence.hpp"
#include "stencil_level.hpp"

namespace drape::alignment {

/// Of one of the two outlines, with whether the other one is there too.
struct OutlinePiece {
  Eigen::Vector2d at;  // in the window
  double length = 0;
  bool fits = false;
};

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

  /// Of both outlines, as match() compares them.
  [[nodiscard]] std::vector<OutlinePiece> pieces(const OutlineDrawing& drawing, int level, double reach_px,
                                                 double inlier_px) const;

  /// How far two outlines that overlap so much (0..1) are apart in the mean, in photo pixels, if it is along
  /// all of the photo's.
  [[nodiscard]] double mean_distance_px(double overlap) const;

  [[nodiscard]] const StencilLevel& at(int level) const { return levels_[static_cast<std::size_t>(level)]; }

 private:
  [[nodiscard]] Agreement compared(const OutlineDrawing& drawing, int level, double reach_px,
                                   double inlier_px, std::vector<RimResidual>& residuals,
                                   std::vector<OutlinePiece>* pieces) const;

  std::vector<StencilLevel> levels_;
};

}  // namespace drape::alignment
