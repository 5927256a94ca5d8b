#include "stencil_evidence.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

namespace drape::alignment {
namespace {

// Sizes of the object at the levels below the photo's own resolution, in pixels.
constexpr int level_extents_px[] = {96, 288, 1000};
// How far off the outline is still seen; at the coarsest level a sixth of the object.
constexpr double reach_px = 8;
constexpr double coarse_reach_px = 16;
constexpr double same_side = 0.3;  // cosine between the outward directions of what may be matched
constexpr double beyond_border_px = 2;
constexpr double at_border_px = 2;
constexpr double most_beyond = 0.08;   // of the window's longer side: what bulges out of a hole of the scan
constexpr double unseen_weight = 0.5;  // of outline that the scan says nothing of
constexpr double beyond_sample_px = 1.5;  // along a straight edge: its direction is good for no more

std::vector<int> level_steps(int extent) {
  std::vector<int> steps;
  for (const int target : level_extents_px) {
    const int step = (extent + target - 1) / target;
    if (step > 1 && (steps.empty() || 2 * step <= steps.back())) steps.push_back(step);
  }
  steps.push_back(1);
  return steps;
}

class StencilRolls final : public Evidence::RollScores {
 public:
  StencilRolls(const StencilLevel& level, const PolarFrame& frame) {
    const auto sampled = [&](const BitImage& image) {
      return polar_bits(frame, [&](double x, double y) {
        return image.at(static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)));
      });
    };
    stencil_.object = sampled(level.object);
    stencil_.known = sampled(level.known);
  }
  void score(const PolarBits& view, std::span<float, polar_angles> scores) const override {
    score_rolls(stencil_, view, scores);
  }

 private:
  PolarStencil stencil_;
};

// Rim samples in square cells. What is near is looked for in rings of cells about a place: most outlines that
// are compared lie close.
class RimCells {
 public:
  RimCells(const std::vector<RimSample>& rim, const Window& window)
      : none_(rim.size()), size_(std::max(4.0, std::max(window.width, window.height) / 96.0)) {
    columns_ = static_cast<int>(window.width / size_) + 3;
    rows_ = static_cast<int>(window.height / size_) + 3;
    begin_.assign(static_cast<std::size_t>(columns_ * rows_) + 2, 0);
    for (const RimSample& sample : rim) ++begin_[cell(sample.at) + 2];
    for (std::size_t i = 2; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    places_.resize(rim.size());
    for (std::size_t i = 0; i < rim.size(); ++i)
      places_[begin_[cell(rim[i].at) + 1]++] = {rim[i].at, rim[i].outward, i, rim[i].border};
  }

  /// The nearest sample that looks the same way, or as many as there are.
  [[nodiscard]] std::size_t nearest(const ContourPoint& point, double reach) const {
    std::size_t best = none_;
    double best_squared = reach * reach;
    const int column = index(point.at.x(), columns_);
    const int row = index(point.at.y(), rows_);
    const double to_side = distance_to_side(point.at, column, row);
    for (int ring = 0;; ++ring) {
      const double bound = ring == 0 ? 0 : (ring - 1) * size_ + to_side;
      if (bound * bound >= best_squared) return best;
      each_on_ring(column, row, ring, [&](const Place& place) {
        const double squared = (place.at - point.at).squaredNorm();
        if (squared >= best_squared || place.outward.dot(point.outward) < same_side) return;
        best = place.sample;
        best_squared = squared;
      });
    }
  }

  /// Whether the scan ends there.
  [[nodiscard]] bool border_at(const Eigen::Vector2d& at) const {
    bool border = false;
    for (int ring = 0; ring < 2; ++ring)
      each_on_ring(index(at.x(), columns_), index(at.y(), rows_), ring, [&](const Place& place) {
        border |= place.border && (place.at - at).norm() < at_border_px;
      });
    return border;
  }

 private:
  struct Place {
    Eigen::Vector2d at, outward;
    std::size_t sample = 0;
    bool border = false;
  };

  [[nodiscard]] int index(double x, int count) const {
    return std::clamp(static_cast<int>(std::floor(x / size_)) + 1, 0, count - 1);
  }
  [[nodiscard]] std::size_t cell(const Eigen::Vector2d& at) const {
    return static_cast<std::size_t>(index(at.y(), rows_) * columns_ + index(at.x(), columns_));
  }
  // From a place to the nearest side of the cell that it is in.
  [[nodiscard]] double distance_to_side(const Eigen::Vector2d& at, int column, int row) const {
    const double x = at.x() - (column - 1) * size_;
    const double y = at.y() - (row - 1) * size_;
    return std::max(0.0, std::min({x, size_ - x, y, size_ - y}));
  }
  template <class Visit>
  void each_on_ring(int column, int row, int ring, Visit visit) const {
    for (int y = std::max(0, row - ring); y <= std::min(rows_ - 1, row + ring); ++y) {
      const int step = ring == 0 || std::abs(y - row) == ring ? 1 : 2 * ring;
      for (int x = column - ring; x <= column + ring; x += step) {
        if (x < 0 || x >= columns_) continue;
        const auto here = static_cast<std::size_t>(y * columns_ + x);
        for (std::uint32_t i = begin_[here]; i < begin_[here + 1]; ++i) visit(places_[i]);
      }
    }
  }

  std::size_t none_;
  double size_;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::uint32_t> begin_;
  std::vector<Place> places_;
};

// Holes of a scan that lie before the object in the photo count as covered: the mesh was not measured there,
// the object is (the thesis's Will Rogers). A handle's opening stays open, as the photo is clear there.
// `beyond` is what of the object lies past the scan's borders; empty: nothing.
double overlap_of(const OutlineDrawing& drawing, const StencilLevel& level, const BitImage& beyond) {
  const std::span<const std::uint64_t> model = drawing.stencil().words();
  const std::span<const std::uint64_t> gaps = drawing.gaps().words();
  const std::span<const std::uint64_t> past = beyond.words();
  const std::span<const std::uint64_t> object = level.object.words();
  const std::span<const std::uint64_t> known = level.known.words();
  std::int64_t both = 0;
  std::int64_t either = 0;
  for (std::size_t i = 0; i < model.size(); ++i) {
    std::uint64_t covered = model[i] & known[i];
    if (!gaps.empty()) covered |= gaps[i] & object[i];
    if (!past.empty()) covered |= past[i];
    both += std::popcount(covered & object[i]);
    either += std::popcount(covered | object[i]);
  }
  return either == 0 ? 0 : static_cast<double>(both) / static_cast<double>(either);
}

bool set_at(const BitImage& image, const Eigen::Vector2d& x) {
  return image.at(static_cast<int>(std::floor(x.x())), static_cast<int>(std::floor(x.y())));
}

// The object goes on in the photo where the scan ends: at a hole of it, or at a border.
bool beside_unseen(const RimSample& sample, const OutlineDrawing& drawing, const StencilLevel& level) {
  if (drawing.gaps().words().empty()) return false;
  const Eigen::Vector2d beside = sample.at + sample.outward;
  if (set_at(drawing.gaps(), beside) && set_at(level.object, beside)) return true;
  return sample.border && set_at(level.object, sample.at + beyond_border_px * sample.outward);
}

// How far it is from a piece of the photo's outline inwards to where the scan ends; nothing where it is the
// object that ends.
std::optional<int> depth_to_scan(const ContourPoint& point, const OutlineDrawing& drawing,
                                 const StencilLevel& level, const RimCells& cells) {
  const auto most = static_cast<int>(most_beyond * std::max(level.window.width, level.window.height));
  for (int depth = 1; depth < most; ++depth) {
    const Eigen::Vector2d x = point.at - depth * point.outward;
    if (!set_at(level.object, x)) return std::nullopt;
    if (set_at(drawing.gaps(), x)) return depth;
    if (set_at(drawing.stencil(), x)) return cells.border_at(x) ? std::optional<int>(depth) : std::nullopt;
  }
  return std::nullopt;
}

// What of the object lies past the scan's borders, as the pieces of the photo's outline tell that no rim is
// near.
class BeyondScan {
 public:
  BeyondScan(const OutlineDrawing& drawing, const StencilLevel& level, const RimCells& cells)
      : drawing_(drawing), level_(level), cells_(cells) {
    if (!drawing.gaps().words().empty()) pixels_ = BitImage(level.window.width, level.window.height);
  }

  /// Whether it is the scan that ends before this piece.
  bool add(const ContourPoint& point) {
    if (pixels_.words().empty()) return false;
    const std::optional<int> depth = depth_to_scan(point, drawing_, level_, cells_);
    if (!depth) return false;
    for (int i = 1; i < *depth; ++i) {
      const Eigen::Vector2d x = point.at - i * point.outward;
      pixels_.set(static_cast<int>(std::floor(x.x())), static_cast<int>(std::floor(x.y())));
    }
    return true;
  }
  [[nodiscard]] const BitImage& pixels() const { return pixels_; }

 private:
  const OutlineDrawing& drawing_;
  const StencilLevel& level_;
  const RimCells& cells_;
  BitImage pixels_;
};

struct Tally {
  double inlier = 0, total = 0, squares = 0, weighted = 0;
  void add(double length, double distance, double inlier_px) {
    total += length;
    if (std::abs(distance) > inlier_px) return;
    inlier += length;
    squares += length * distance * distance;
    weighted += length * (1 - distance * distance / (inlier_px * inlier_px));
  }
  void miss(double length) { total += length; }
  [[nodiscard]] double share(double of) const { return total > 0 ? of / total : 0; }
};

}  // namespace

StencilEvidence::StencilEvidence(const Image8& stencil, const PhotoPlane& plane) {
  for (const int step : level_steps(object_extent(stencil)))
    levels_.push_back(stencil_level(stencil, plane, step, levels_.empty() ? coarse_reach_px : reach_px));
}

std::vector<PolarFrame> StencilEvidence::frames(int /*effort*/) const {
  return {polar_frame(levels_.front().object)};
}

std::unique_ptr<Evidence::RollScores> StencilEvidence::rolls(const PolarFrame& frame) const {
  return std::make_unique<StencilRolls>(levels_.front(), frame);
}

Agreement StencilEvidence::match(const OutlineDrawing& drawing, int level, double reach, double inlier_px,
                                 std::vector<RimResidual>& residuals) const {
  return compared(drawing, level, reach, inlier_px, residuals, nullptr);
}

std::vector<OutlinePiece> StencilEvidence::pieces(const OutlineDrawing& drawing, int level, double reach,
                                                  double inlier_px) const {
  std::vector<RimResidual> residuals;
  std::vector<OutlinePiece> pieces;
  (void)compared(drawing, level, reach, inlier_px, residuals, &pieces);
  return pieces;
}

double StencilEvidence::mean_distance_px(double overlap) const {
  const StencilLevel& level = levels_.back();
  std::int64_t pixels = 0;
  for (const std::uint64_t word : level.object.words()) pixels += std::popcount(word);
  return (1 - overlap) * static_cast<double>(pixels) / std::max(1.0, level.contour_length) /
         level.window.px_per_photo_px;
}

Agreement StencilEvidence::compared(const OutlineDrawing& drawing, int level_index, double reach,
                                    double inlier_px, std::vector<RimResidual>& residuals,
                                    std::vector<OutlinePiece>* pieces) const {
  const StencilLevel& level = at(level_index);
  const std::vector<RimSample>& rim = drawing.rim();
  residuals.clear();
  Tally from_rim;
  // Forward: every piece of the rim looks for the photo's outline.
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const RimSample& sample = rim[i];
    if (!set_at(level.known, sample.at)) continue;
    if (beside_unseen(sample, drawing, level)) continue;
    const std::int32_t near =
        level.nearest.at(static_cast<int>(sample.at.x()), static_cast<int>(sample.at.y()));
    double distance = reach + 1;
    if (near != StencilLevel::none) {
      const ContourPoint& point = level.contour[static_cast<std::size_t>(near)];
      if (point.outward.dot(sample.outward) >= same_side) distance = point.outward.dot(point.at - sample.at);
      if (std::abs(distance) <= reach)
        residuals.push_back({i, point.outward, distance, sample.length, point.at - sample.at});
    }
    from_rim.add(sample.length, distance, inlier_px);
    if (pieces != nullptr) pieces->push_back({sample.at, sample.length, std::abs(distance) <= inlier_px});
  }
  // Backward: every piece of the photo's outline looks for the rim.
  Tally from_image;
  const RimCells cells(rim, level.window);
  BeyondScan beyond(drawing, level, cells);
  for (const ContourPoint& point : level.contour) {
    const std::size_t near = cells.nearest(point, reach);
    double distance = reach + 1;
    Eigen::Vector2d direction;
    Eigen::Vector2d offset;
    if (near != rim.size()) {
      const RimSample& sample = rim[near];
      offset = point.at - sample.at;
      const Eigen::Vector2d along(-sample.outward.y(), sample.outward.x());
      const bool by_edge = sample.straight && std::abs(along.dot(offset)) <= beyond_sample_px;
      direction = by_edge ? sample.outward : point.outward;
      distance = direction.dot(offset);
    }
    if (std::abs(distance) > inlier_px && beyond.add(point)) {
      from_image.miss(unseen_weight * point.length);
      continue;
    }
    if (near != rim.size()) residuals.push_back({near, direction, distance, point.length, offset});
    from_image.add(point.length, distance, inlier_px);
    if (pieces != nullptr) pieces->push_back({point.at, point.length, std::abs(distance) <= inlier_px});
  }
  Agreement agreement;
  agreement.overlap = overlap_of(drawing, level, beyond.pixels());
  agreement.rim_inliers = from_rim.share(from_rim.inlier);
  agreement.image_inliers = from_image.share(from_image.inlier);
  agreement.fit = 0.5 * (from_rim.share(from_rim.weighted) + from_image.share(from_image.weighted));
  const double inlier = from_rim.inlier + from_image.inlier;
  agreement.rms_px = inlier > 0 ? std::sqrt((from_rim.squares + from_image.squares) / inlier) : 0;
  return agreement;
}

}  // namespace drape::alignment
