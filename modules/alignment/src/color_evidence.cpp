#include "color_evidence.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "drape/base/error.hpp"

namespace drape::alignment {
namespace {

constexpr int clusters = 24;
constexpr double box_margin = 0.25;  // of the box, on each side
// Longer sides of the windows. Within a box the object fills most of it; else it may be small.
constexpr int box_levels_px[] = {128, 256, 512};
constexpr int photo_levels_px[] = {256, 512, 1024};
constexpr double most_magnified = 2;
constexpr double surroundings = 0.35;   // of the object's size: what its colours are told from
constexpr double edge_difference = 12;  // Lab step that counts as an edge
constexpr int edge_reach_px = 3;
// Of the score of a coarse pose: how much is lost without edges, and without places where the colours change.
constexpr double edge_share = 0.5;
constexpr double inlier_share = 0.3;
// Of the score of a refined one: powers. Other things of one colour are parted from the rest as well as the
// object is, but only the object's own outline follows the edges all round (simulated photos with clutter).
constexpr double edge_power = 2;
constexpr double inlier_power = 3;
// Radii of gyration, in half sides of the box (of a square of its diagonal): of a disc that nearly fills it
// .7, of one that fills 60 % .42.
constexpr double radii_in_box[] = {0.38, 0.45, 0.535, 0.635, 0.75};
constexpr double offsets_in_box[] = {0, -0.08, 0.08, -0.16, 0.16};  // of the box's sides
constexpr double free_gap = 0.25;  // between outline and box, of the box's side: any up to this is as good
constexpr double overshoot_scale = 0.07;
constexpr double gap_scale = 0.12;
// Round a click, in shares of the photo's shorter side, and in radii.
constexpr double least_radius = 0.035;
constexpr double most_radius = 0.33;
constexpr double radius_step = 1.21;

double side_fit(double gap) {
  const double off = gap < 0 ? gap / overshoot_scale : std::max(0.0, gap - free_gap) / gap_scale;
  return std::exp(-off * off);
}

/// How likely an outline with these limits is what the box was drawn round.
double box_fit(const PhotoBox& box, const PhotoBox& outline) {
  return side_fit((outline.left - box.left) / box.width()) *
         side_fit((box.right - outline.right) / box.width()) *
         side_fit((outline.top - box.top) / box.height()) *
         side_fit((box.bottom - outline.bottom) / box.height());
}

PhotoBox grown(const PhotoBox& box, double share) {
  return {box.left - share * box.width(), box.top - share * box.height(), box.right + share * box.width(),
          box.bottom + share * box.height()};
}

PhotoBox in_window(const PhotoBox& box, const PhotoPlane& plane, const Window& window) {
  const Eigen::Vector2d least = window.from_photo(plane.to_ideal({box.left, box.top}));
  const Eigen::Vector2d most = window.from_photo(plane.to_ideal({box.right, box.bottom}));
  return {least.x(), least.y(), most.x(), most.y()};
}

std::vector<double> level_scales(double extent_px, bool box) {
  std::vector<double> scales;
  for (const int target : box ? box_levels_px : photo_levels_px) {
    double scale = target / extent_px;
    // Magnified only where the pixels would not do for a start.
    scale = std::min(scale, scales.empty() ? most_magnified : 1.0);
    if (scales.empty() || scale > 1.3 * scales.back()) scales.push_back(scale);
  }
  return scales;
}

std::int64_t count_in(const BitImage& first, const BitImage& second, const PixelRegion& rows) {
  std::int64_t count = 0;
  for (int y = rows.top; y < rows.bottom; ++y) {
    const auto a = first.row(y);
    const auto b = second.row(y);
    for (std::size_t i = 0; i < a.size(); ++i) count += std::popcount(a[i] & b[i]);
  }
  return count;
}

// Of the pixels between `left` and `right` alone.
std::int64_t count_in(const BitImage& image, const PixelRegion& region) {
  std::int64_t count = 0;
  const auto first = static_cast<std::size_t>(region.left >> 6);
  const auto last = static_cast<std::size_t>((region.right - 1) >> 6);
  for (int y = region.top; y < region.bottom; ++y)
    for (std::size_t i = first; i <= last; ++i) {
      std::uint64_t word = image.row(y)[i];
      if (i == first) word &= ~std::uint64_t{0} << (region.left & 63);
      if (i == last) word &= ~std::uint64_t{0} >> (63 - ((region.right - 1) & 63));
      count += std::popcount(word);
    }
  return count;
}

// Of the outline, in pixels, that the window's border stands for.
double cut_length(const BitImage& stencil) {
  double cut = 0;
  for (int x = 0; x < stencil.width(); ++x)
    cut += (stencil.at(x, 0) ? 1 : 0) + (stencil.at(x, stencil.height() - 1) ? 1 : 0);
  for (int y = 0; y < stencil.height(); ++y)
    cut += (stencil.at(0, y) ? 1 : 0) + (stencil.at(stencil.width() - 1, y) ? 1 : 0);
  return cut;
}

double outline_weight(const Agreement& fit, bool refined) {
  if (refined) return std::pow(fit.rim_inliers, edge_power) * std::pow(fit.image_inliers, inlier_power);
  return (1 - edge_share + edge_share * fit.rim_inliers) *
         (1 - inlier_share + inlier_share * fit.image_inliers);
}

}  // namespace

ColorPlace color_place(const PhotoEvidence& evidence) {
  ColorPlace place;
  const double width = evidence.stencil.width();
  const double height = evidence.stencil.height();
  if (evidence.box_px) {
    const auto& [x, y, w, h] = *evidence.box_px;
    if (!(w > 0 && h > 0 && x < width && y < height && x + w > 0 && y + h > 0))
      throw config_error("box_px [{}, {}, {}, {}] holds no pixel of the photo of {} x {} pixels", x, y, w, h,
                         width, height);
    place.box = PhotoBox{x, y, x + w, y + h};
  } else if (evidence.click_px) {
    const auto& [x, y] = *evidence.click_px;
    if (!(x >= 0 && y >= 0 && x <= width && y <= height))
      throw config_error("click_px [{}, {}] lies outside the photo of {} x {} pixels", x, y, width, height);
    place.click = Eigen::Vector2d(x, y);
  }
  return place;
}

ColorEvidence::ColorEvidence(const Image8& rgb, const PhotoPlane& plane, const ColorPlace& place) {
  std::vector<LabColor> colors;
  add_levels(rgb.width(), rgb.height(), plane, place, [&](const PhotoBox& box, double scale) {
    const LabWindow window = lab_window(rgb, plane, box, scale);
    if (colors.empty()) colors = color_clusters(window, clusters);
    return color_level(window, colors);
  });
}

ColorEvidence::ColorEvidence(const Image<std::int32_t>& segments, const PhotoPlane& plane,
                             const ColorPlace& place) {
  add_levels(segments.width(), segments.height(), plane, place,
             [&](const PhotoBox& box, double scale) { return segment_level(segments, plane, box, scale); });
}

template <class MakeLevel>
void ColorEvidence::add_levels(int width, int height, const PhotoPlane& plane, const ColorPlace& place,
                               MakeLevel make_level) {
  const PhotoBox photo{0, 0, static_cast<double>(width), static_cast<double>(height)};
  PhotoBox seen = photo;
  if (place.box) {
    const PhotoBox wide = grown(*place.box, box_margin);
    seen = {std::max(photo.left, wide.left), std::max(photo.top, wide.top), std::min(photo.right, wide.right),
            std::min(photo.bottom, wide.bottom)};
  }
  for (const double scale : level_scales(std::max(seen.width(), seen.height()), place.box.has_value())) {
    Level level;
    static_cast<ColorLevel&>(level) = make_level(seen, scale);
    const PixelRegion all{0, 0, level.window.width, level.window.height};
    for (const BitImage& label : level.labels)
      level.pixels.push_back(static_cast<double>(count_in(label, all)));
    if (place.box) level.box = in_window(*place.box, plane, level.window);
    if (place.click) level.click = level.window.from_photo(plane.to_ideal(*place.click));
    levels_.push_back(std::move(level));
  }
  const Level& coarse = levels_.front();
  region_.click = coarse.click;
  if (!coarse.box) return;
  region_.pixels = coarse.pixels;
  region_.fit = [box = *coarse.box](const Eigen::Vector2f& least, const Eigen::Vector2f& most) {
    return static_cast<float>(box_fit(box, {least.x(), least.y(), most.x(), most.y()}));
  };
}

std::vector<PolarFrame> ColorEvidence::frames(int /*effort*/) const {
  const Level& level = levels_.front();
  std::vector<PolarFrame> frames;
  // One colour: nothing can be told, anywhere.
  if (level.labels.size() < 2) return {{Eigen::Vector2d(level.window.width, level.window.height) / 2, 1}};
  if (level.box) {
    const PhotoBox& box = *level.box;
    const Eigen::Vector2d middle((box.left + box.right) / 2, (box.top + box.bottom) / 2);
    const double half = std::hypot(box.width(), box.height()) / std::sqrt(8.0);
    for (const double radius :
         {radii_in_box[2], radii_in_box[1], radii_in_box[3], radii_in_box[0], radii_in_box[4]})
      for (const double dy : offsets_in_box)
        for (const double dx : offsets_in_box)
          frames.push_back({middle + Eigen::Vector2d(dx * box.width(), dy * box.height()), radius * half});
    return frames;
  }
  const double side = std::min(level.window.width, level.window.height);
  for (double radius = least_radius * side; radius < most_radius * side; radius *= radius_step) {
    if (level.click) {
      for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x)
          frames.push_back({*level.click + 0.5 * radius * Eigen::Vector2d(x, y), radius});
      continue;
    }
    const double step = 0.6 * radius;
    for (double y = radius; y <= level.window.height - radius; y += step)
      for (double x = radius; x <= level.window.width - radius; x += step) frames.push_back({{x, y}, radius});
  }
  return frames;
}

std::unique_ptr<Evidence::RollScores> ColorEvidence::rolls(const PolarFrame& frame) const {
  return std::make_unique<ColorRolls>(levels_.front(), frame, region_);
}

double ColorEvidence::parting(const OutlineDrawing& drawing, const Level& level) const {
  const PixelRegion about = region_about(drawing.stencil(), level.box ? 0 : 0.5);
  if (about.right <= about.left) return 0;
  std::vector<double> inside;
  std::vector<double> all = level.pixels;
  for (std::size_t c = 0; c < level.labels.size(); ++c) {
    inside.push_back(static_cast<double>(count_in(level.labels[c], drawing.stencil(), about)));
    if (!level.box) all[c] = static_cast<double>(count_in(level.labels[c], about));
  }
  double parted = uncertainty_coefficient(inside, all);
  if (level.box) {
    const PixelRegion tight = region_about(drawing.stencil(), 0);
    parted *= box_fit(*level.box, {tight.left + 2.0, tight.top + 2.0, tight.right - 2.0, tight.bottom - 2.0});
  }
  if (level.click && !drawing.stencil().at(static_cast<int>(std::floor(level.click->x())),
                                           static_cast<int>(std::floor(level.click->y()))))
    parted *= 0.5;
  return parted;
}

Agreement ColorEvidence::match(const OutlineDrawing& drawing, int level_index, double reach, double inlier_px,
                               std::vector<RimResidual>& residuals) const {
  const Level& level = at(level_index);
  residuals.clear();
  Agreement agreement;
  const PixelRegion around = region_about(drawing.stencil(), surroundings);
  if (around.right <= around.left) return agreement;
  const ColorModel model(level, drawing.stencil(), around, level_index > 0);
  double total = 0;
  double inlier = 0;
  double on_edge = 0;
  double squares = 0;
  const std::vector<RimSample>& rim = drawing.rim();
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const RimSample& sample = rim[i];
    if (!level.known.at(static_cast<int>(sample.at.x()), static_cast<int>(sample.at.y()))) continue;
    const RimStep step = rim_step(level, model, sample, static_cast<int>(std::lround(reach)));
    residuals.push_back({i, sample.outward, step.distance_px, sample.length / (step.variance_px2 + 1)});
    total += sample.length;
    if (edge_step(level, sample, edge_reach_px) > edge_difference) on_edge += sample.length;
    if (std::abs(step.distance_px) > inlier_px) continue;
    inlier += sample.length;
    squares += sample.length * step.distance_px * step.distance_px;
  }
  agreement.overlap = parting(drawing, level);
  agreement.rim_inliers = total > 0 ? on_edge / total : 0;
  agreement.image_inliers = total > 0 ? inlier / total : 0;
  agreement.rms_px = inlier > 0 ? std::sqrt(squares / inlier) : 0;
  // Of what the window cuts off nothing is seen.
  const double seen = total > 0 ? total / (total + cut_length(drawing.stencil())) : 0;
  agreement.ranking = agreement.overlap * seen * outline_weight(agreement, level_index > 0);
  return agreement;
}

SearchPlan ColorEvidence::plan() const {
  SearchPlan plan;
  plan.good_score = 0;  // the search has no other places to look at: a second one would find the same
  plan.candidates = 120;
  plan.most_frames = levels_.front().box ? 64 : 150;
  plan.distinct_place = plan.distinct_size = 0.2;
  plan.glance_reach_px = 14;
  plan.kept_after_glance = plan.kept_with_effort = 24;
  plan.kept_for_middle = 12;
  plan.kept_for_full = 6;
  plan.glance_margin = plan.coarse_margin = plan.middle_margin = 1;
  if (levels_.front().box) return plan;
  // Parts of the object, and anywhere in the photo other things, part the colours as well as the object does
  // while its pose is coarse: each place keeps its best poses until they are refined.
  plan.places = 12;
  plan.most_in_a_place = 8;
  plan.glanced_in_a_place = 6;
  plan.middle_in_a_place = 3;
  plan.finalists_in_a_place = 2;
  if (levels_.front().click) {
    plan.kept_after_glance = plan.kept_with_effort = 48;
    plan.kept_for_middle = 20;
    return plan;
  }
  plan.most_frames = 300;
  plan.candidates = 400;
  plan.places = 16;
  plan.kept_after_glance = plan.kept_with_effort = 100;
  plan.kept_for_middle = 32;
  plan.kept_for_full = 8;
  return plan;
}

}  // namespace drape::alignment
