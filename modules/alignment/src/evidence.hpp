// What a photo says about the object's outline, whatever it says it with.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "outline_drawing.hpp"
#include "polar_view.hpp"
#include "stencil_level.hpp"

namespace drape::alignment {

/// The rim sample `sample` should move by `distance_px` along `direction` (window pixels).
struct RimResidual {
  std::size_t sample = 0;
  Eigen::Vector2d direction = Eigen::Vector2d::Zero();  // unit
  double distance_px = 0;
  double weight = 0;                                 // length of outline it stands for
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  // from the sample to what it was matched with
};

/// How a drawn pose fits. Shares are of length, 0..1.
struct Agreement {
  double overlap = 0;        // intersection over union, 0..1
  double rim_inliers = 0;    // of the model's rim where the photo says anything
  double image_inliers = 0;  // of the photo's outline
  double rms_px = 0;         // of the inliers, in window pixels
  /// Of both outlines, the inliers weighted by 1 - (distance / what is an inlier)^2.
  double fit = 0;

  /// What poses are ranked by, 0..1. The outline says more than the area: of a stencil that is wrong in part
  /// the rest of the outline still fits the right pose, while the area fits many, and some of them better.
  [[nodiscard]] double score() const { return ranking ? *ranking : 0.1 * overlap + 0.9 * fit; }
  /// What iterates of one pose are ranked by: the area still grows where the outline already fits all round.
  [[nodiscard]] double closeness() const {
    if (ranking) return *ranking + overlap;
    return fit + (std::min(rim_inliers, image_inliers) > 0.85 ? overlap : 0.0);
  }
  /// How much of the stencil a pose explains, 0..1.
  [[nodiscard]] double explained() const { return 0.25 * overlap + 0.375 * (rim_inliers + image_inliers); }
  std::optional<double> ranking;  // of evidence that has a measure of its own
  double lit = 0;                 // of the colours inside, by light on the mesh; 0..1; 0 where nobody asked
};

/// How widely an evidence wants its poses searched.
struct SearchPlan {
  std::size_t candidates = 48;               // of the coarse search
  std::size_t candidates_with_effort = 300;  // where the first ones are no good
  double distinct_place = 0.1;               // of candidates alike in rotation: in radii of the mesh,
  double distinct_size = 0.1;                // and in logarithms of their sizes
  std::size_t most_in_a_place = 1000;        // of candidates: each place and size that the object may have
  std::size_t most_frames = 1000;            // of all, those where some view fits best
  double good_score = 0.9;                   // at the coarse level: with less the evidence is not trusted
  double glance_reach_px = 16;
  std::size_t kept_after_glance = 16;
  std::size_t kept_with_effort = 32;
  // So many of the places that the first glance finds are searched once more, each by itself.
  std::size_t places = 0;
  std::size_t candidates_of_a_size = 10;  // there
  // What is kept of one place and size, when there are other things that part the photo as well.
  std::size_t glanced_in_a_place = 1000;
  std::size_t middle_in_a_place = 1000;
  std::size_t finalists_in_a_place = 1000;
  std::size_t kept_for_middle = 8;
  std::size_t kept_for_full = 4;
  // What is worse than the best by more than this is no rival of it at the next level either.
  double glance_margin = 0.15;  // while nothing says that the evidence is wrong in part
  double coarse_margin = 0.15;
  double middle_margin = 0.08;
};

/// The search, the refinement and the verdict ask for nothing else. Levels go from coarse to the photo's
/// resolution; all positions are in pixels about the assumed principal point.
class Evidence {
 public:
  virtual ~Evidence() = default;

  [[nodiscard]] virtual int levels() const = 0;
  [[nodiscard]] virtual const Window& window(int level) const = 0;

  /// Places and sizes that the object may have in the photo, the likeliest first; `effort` 0: that one alone.
  /// In pixels of level 0's window.
  [[nodiscard]] virtual std::vector<PolarFrame> frames(int effort) const = 0;

  /// How well a view fits in a frame, for each of its rolls; comparable between frames and views.
  class RollScores {
   public:
    virtual ~RollScores() = default;
    virtual void score(const PolarBits& view, std::span<float, polar_angles> scores) const = 0;
  };
  [[nodiscard]] virtual std::unique_ptr<RollScores> rolls(const PolarFrame& frame) const = 0;

  [[nodiscard]] virtual SearchPlan plan() const { return {}; }

  /// The outline at level 0, which may be wrong in part; nothing for evidence without one. It is searched
  /// instead of further frames.
  [[nodiscard]] virtual const StencilLevel* outline() const { return nullptr; }

  /// What pulls at the rim of a drawn pose from up to `reach_px` away (into `residuals`), and how well it
  /// fits; `inlier_px` is what counts as on the outline.
  [[nodiscard]] virtual Agreement match(const OutlineDrawing& drawing, int level, double reach_px,
                                        double inlier_px, std::vector<RimResidual>& residuals) const = 0;
};

}  // namespace drape::alignment
