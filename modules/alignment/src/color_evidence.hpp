// Evidence of the photo's colours alone: no stencil is needed.
#pragma once

#include <optional>
#include <vector>

#include "color_level.hpp"
#include "color_model.hpp"
#include "color_rolls.hpp"
#include "evidence.hpp"
#include "photo_plane.hpp"

namespace drape::alignment {

/// Where the object is: within a box with some margin, round a point of it, or anywhere.
struct ColorPlace {
  std::optional<PhotoBox> box;
  std::optional<Eigen::Vector2d> click;  // photo pixels
};

/// Error{config} for a box without any of the photo, or a click outside of it.
[[nodiscard]] ColorPlace color_place(const PhotoEvidence& evidence);

/// A pose is as good as its outline parts the photo's colours (uncertainty_coefficient), and as it lies on
/// edges. At first no colour model is known: 24 clusters stand for all. Then pose and colour models of object
/// and surroundings are refined in turn.
class ColorEvidence final : public Evidence {
 public:
  /// `rgb` must not be empty.
  ColorEvidence(const Image8& rgb, const PhotoPlane& plane, const ColorPlace& place);
  /// The same with a photo's segments for colours: the outline is to part them, and to run where they meet.
  ColorEvidence(const Image<std::int32_t>& segments, const PhotoPlane& plane, const ColorPlace& place);

  [[nodiscard]] int levels() const override { return static_cast<int>(levels_.size()); }
  [[nodiscard]] const Window& window(int level) const override { return at(level).window; }
  [[nodiscard]] std::vector<PolarFrame> frames(int effort) const override;
  [[nodiscard]] std::unique_ptr<RollScores> rolls(const PolarFrame& frame) const override;
  [[nodiscard]] Agreement match(const OutlineDrawing& drawing, int level, double reach_px, double inlier_px,
                                std::vector<RimResidual>& residuals) const override;
  [[nodiscard]] SearchPlan plan() const override;

  /// The finest of the levels.
  [[nodiscard]] const ColorLevel& finest() const { return levels_.back(); }

 private:
  struct Level : ColorLevel {
    std::vector<double> pixels;            // of each label
    std::optional<PhotoBox> box;           // in window pixels
    std::optional<Eigen::Vector2d> click;  // in window pixels
  };
  [[nodiscard]] const Level& at(int level) const { return levels_[static_cast<std::size_t>(level)]; }
  // make_level(box in the photo, scale)
  template <class MakeLevel>
  void add_levels(int width, int height, const PhotoPlane& plane, const ColorPlace& place,
                  MakeLevel make_level);
  [[nodiscard]] double parting(const OutlineDrawing& drawing, const Level& level) const;

  std::vector<Level> levels_;
  ColorRegion region_;  // of level 0
};

}  // namespace drape::alignment
