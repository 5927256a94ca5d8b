#include "drape/segmentation/segment_photo.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "boundary_refinement.hpp"
#include "drape/base/error.hpp"
#include "drape/base/random.hpp"
#include "grabcut.hpp"
#include "kmeans_clusters.hpp"
#include "object_evidence.hpp"
#include "region_graph.hpp"
#include "stencil_shape.hpp"

namespace drape::segmentation {
namespace {

constexpr double least_segment_share = 0.001;   // of the photo; smaller specks join a neighbour
constexpr double least_segment_difference = 3;  // Lab; neighbours of nearly one colour are one segment
constexpr double edge_difference = 12;          // Lab step across the outline that counts as an edge
constexpr int edge_reach_px = 2;                // how far inside and outside the outline it is measured

// The photo at working size, and what was found on it.
struct Reduced {
  Image8 rgb;
  ImageF lab;
  Labels labels;  // segments, largest first
  Hints hints;
  ImageF evidence;
  float threshold = 0.5F;
};

std::size_t at(std::int32_t label) {
  return static_cast<std::size_t>(label);
}

int clamped(double value, int most) {
  return static_cast<int>(std::clamp(std::floor(value), 0.0, static_cast<double>(most)));
}

Hints hints_of(const PhotoRegion& region, const Image8& photo, const Image8& small) {
  const double fx = static_cast<double>(small.width()) / photo.width();
  const double fy = static_cast<double>(small.height()) / photo.height();
  Hints hints;
  if (region.click_px)
    hints.click = {clamped((*region.click_px)[0] * fx, small.width() - 1),
                   clamped((*region.click_px)[1] * fy, small.height() - 1)};
  if (region.box_px) {
    const auto& [x, y, width, height] = *region.box_px;
    const int left = clamped(x * fx, small.width() - 1);
    const int top = clamped(y * fy, small.height() - 1);
    hints.box = {left, top, std::max(left + 1, clamped(std::ceil((x + width) * fx), small.width())),
                 std::max(top + 1, clamped(std::ceil((y + height) * fy), small.height()))};
  }
  return hints;
}

void check(const Image8& rgb, const Image8& mask, const PhotoRegion& region, const SegmentOptions& options) {
  if (rgb.empty()) throw input_error("the photo has no pixels");
  if (rgb.channels() != 3) throw input_error("the photo has {} channels instead of 3", rgb.channels());
  if (!mask.empty() && (mask.width() != rgb.width() || mask.height() != rgb.height() || mask.channels() != 1))
    throw input_error(
        "the mask is {} x {} pixels with {} channels; the photo is {} x {}, so it needs one channel "
        "of that size",
        mask.width(), mask.height(), mask.channels(), rgb.width(), rgb.height());
  if (mask.empty() && options.method == Method::mask)
    throw config_error("segment.method: mask needs a mask, and the photo has none (input.photos: mask)");
  if (mask.empty() && options.method == Method::alpha)
    throw config_error("segment.method: alpha needs a photo with an alpha channel");
  const bool wants_click = options.pick == Pick::click || options.pick == Pick::segment;
  if (wants_click && !region.click_px) throw config_error("segment.pick wants input.photos: click_px");
  if (options.pick == Pick::box && !region.box_px)
    throw config_error("segment.pick wants input.photos: box_px");
  if (options.pick == Pick::indices && options.indices.empty())
    throw config_error("segment.pick: indices needs segment.indices, the labels of segments.json");
  if (region.click_px) {
    const auto& [x, y] = *region.click_px;
    if (!(x >= 0 && y >= 0 && x <= rgb.width() && y <= rgb.height()))
      throw config_error("click_px [{}, {}] lies outside the photo of {} x {} pixels", x, y, rgb.width(),
                         rgb.height());
  }
  if (region.box_px) {
    const auto& [x, y, width, height] = *region.box_px;
    if (!(width > 0 && height > 0 && x < rgb.width() && y < rgb.height() && x + width > 0 && y + height > 0))
      throw config_error("box_px [{}, {}, {}, {}] holds no pixel of the photo of {} x {} pixels", x, y, width,
                         height, rgb.width(), rgb.height());
  }
}

// With a box, what a minimum cut started inside it finds: 0 or 1. Without, that has no safe background to
// learn from and takes in look-alikes, while standing out from the border misses dull parts: the mean of the
// two.
ImageF evidence_of(const Reduced& r, std::uint64_t seed) {
  Hints within = r.hints;
  if (!within.box) within.box = inset_box(r.rgb.width(), r.rgb.height());
  const Image8 cut = grabcut(r.rgb, elliptic_guess(r.rgb.width(), r.rgb.height(), *within.box), within, seed);
  ImageF evidence(r.rgb.width(), r.rgb.height(), 1, 0.F);
  if (!r.hints.box) evidence = object_evidence(r.lab, r.hints);
  if (!r.hints.box && *std::max_element(evidence.data().begin(), evidence.data().end()) == 0)
    return evidence;                             // no contrast: nothing to cut either
  const float share = r.hints.box ? 1.F : 0.6F;  // more than half, or enclosed backdrop stays in
  for (std::size_t i = 0; i < evidence.data().size(); ++i) {
    const float in_cut = cut.data()[i] == stencil::object ? 1.F : 0.F;
    evidence.data()[i] += share * (in_cut - evidence.data()[i]);
  }
  return evidence;
}

// The value that splits the evidence into two classes of the most different means (Otsu 1979).
float otsu_threshold(const ImageF& evidence) {
  constexpr int bins = 256;
  std::array<double, bins> histogram{};
  for (const float e : evidence.data())
    ++histogram[static_cast<std::size_t>(std::clamp(static_cast<int>(e * bins), 0, bins - 1))];
  double total = 0;
  double sum = 0;
  for (std::size_t i = 0; i < bins; ++i) {
    total += histogram[i];
    sum += histogram[i] * static_cast<double>(i);
  }
  double below = 0;
  double sum_below = 0;
  double best = 0;
  std::size_t split = bins / 2;
  for (std::size_t i = 0; i + 1 < bins; ++i) {
    below += histogram[i];
    sum_below += histogram[i] * static_cast<double>(i);
    const double above = total - below;
    if (below == 0 || above == 0) continue;
    const double apart = sum_below / below - (sum - sum_below) / above;
    if (below * above * apart * apart <= best) continue;
    best = below * above * apart * apart;
    split = i + 1;
  }
  return static_cast<float>(split) / bins;
}

std::vector<std::uint8_t> picked_segments(const Reduced& r, const SegmentOptions& options) {
  const auto count = at(1 + *std::max_element(r.labels.data().begin(), r.labels.data().end()));
  std::vector<std::uint8_t> picked(count, 0);
  if (options.pick == Pick::indices) {
    for (const double index : options.indices) {
      if (index != std::floor(index) || index >= static_cast<double>(count))
        throw config_error("segment.indices: {} is no segment; the photo has 0 to {}", index, count - 1);
      picked[static_cast<std::size_t>(index)] = 1;
    }
    return picked;
  }
  if (r.hints.click) picked[at(r.labels.at((*r.hints.click)[0], (*r.hints.click)[1]))] = 1;
  if (options.pick == Pick::segment) return picked;
  std::vector<double> sum(count, 0);
  std::vector<double> pixels(count, 0);
  for (std::size_t i = 0; i < r.labels.data().size(); ++i) {
    sum[at(r.labels.data()[i])] += r.evidence.data()[i];
    pixels[at(r.labels.data()[i])] += 1;
  }
  for (std::size_t i = 0; i < count; ++i)
    if (sum[i] > r.threshold * pixels[i]) picked[i] = 1;
  return picked;
}

Image8 union_of(const Labels& labels, const std::vector<std::uint8_t>& picked) {
  Image8 shape(labels.width(), labels.height(), 1, stencil::background);
  for (std::size_t i = 0; i < shape.data().size(); ++i)
    if (picked[at(labels.data()[i])]) shape.data()[i] = stencil::object;
  return shape;
}

Image8 shaped(const Image8& raw, const SegmentOptions& options,
              const std::optional<std::array<int, 2>>& click) {
  const double hole_percent = options.holes == Holes::close ? 1e9 : options.min_hole_percent;
  return without_holes(without_islands(raw, options.min_island_percent / 100, click), hole_percent / 100);
}

// GrabCut at working size, its outline refined on the photo.
Image8 grabcut_stencil(const Reduced& r, const Image8& photo, const std::vector<std::uint8_t>& picked,
                       const SegmentOptions& options, std::uint64_t seed) {
  const bool exact = options.pick == Pick::indices || options.pick == Pick::segment;
  Image8 guess = union_of(r.labels, picked);
  if (!exact)
    for (std::size_t i = 0; i < guess.data().size(); ++i)
      guess.data()[i] = r.evidence.data()[i] > r.threshold ? stencil::object : stencil::background;
  const bool cut_already = r.hints.box && !exact;  // its evidence is a cut
  const Image8 start = shaped(guess, options, r.hints.click);
  const Image8 cut = cut_already ? start : grabcut(r.rgb, start, r.hints, seed);
  Labels sides(cut.width(), cut.height(), 1, 0);
  std::transform(cut.data().begin(), cut.data().end(), sides.data().begin(),
                 [](std::uint8_t v) { return static_cast<std::int32_t>(v == stencil::object); });
  return union_of(refined_labels(sides, r.lab, photo), {0, 1});
}

double edge_share(const Image8& shape, const ImageF& lab) {
  double edges = 0;
  double outline = 0;
  const auto look = [&](int x, int y, int dx, int dy) {
    if (!shape.contains(x + dx, y + dy) || shape.at(x, y) == shape.at(x + dx, y + dy)) return;
    outline += 1;
    const int ax = x - (edge_reach_px - 1) * dx;
    const int ay = y - (edge_reach_px - 1) * dy;
    const int bx = x + edge_reach_px * dx;
    const int by = y + edge_reach_px * dy;
    if (!shape.contains(ax, ay) || !shape.contains(bx, by)) return;
    if (squared_difference(&lab.at(ax, ay), &lab.at(bx, by)) > edge_difference * edge_difference) edges += 1;
  };
  for (int y = 0; y < shape.height(); ++y)
    for (int x = 0; x < shape.width(); ++x) {
      look(x, y, 1, 0);
      look(x, y, 0, 1);
    }
  return outline > 0 ? edges / outline : 0;
}

double confidence_of(const Image8& full, const Reduced& r) {
  Image8 small(r.rgb.width(), r.rgb.height(), 1);
  std::array<double, 2> sum{};
  std::array<double, 2> pixels{};
  for (int y = 0; y < small.height(); ++y)
    for (int x = 0; x < small.width(); ++x) {
      small.at(x, y) = full.at((2 * x + 1) * full.width() / (2 * small.width()),
                               (2 * y + 1) * full.height() / (2 * small.height()));
      const std::size_t side = small.at(x, y) == stencil::object ? 1 : 0;
      sum[side] += r.evidence.at(x, y);
      pixels[side] += 1;
    }
  if (pixels[0] == 0 || pixels[1] == 0) return 0;
  return std::clamp(sum[1] / pixels[1] - sum[0] / pixels[0], 0.0, 1.0) * edge_share(small, r.lab);
}

// Per pixel the distance to the nearest pixel of another label or beyond the photo.
cv::Mat depth_inside(const Labels& labels) {
  cv::Mat same(labels.height() + 2, labels.width() + 2, CV_8U, cv::Scalar(0));
  for (int y = 0; y < labels.height(); ++y)
    for (int x = 0; x < labels.width(); ++x) {
      const bool left = x == 0 || labels.at(x - 1, y) == labels.at(x, y);
      const bool top = y == 0 || labels.at(x, y - 1) == labels.at(x, y);
      same.at<std::uint8_t>(y + 1, x + 1) = left && top ? 1 : 0;
    }
  cv::Mat depth;
  cv::distanceTransform(same, depth, cv::DIST_L2, cv::DIST_MASK_3);
  return depth;
}

std::string yaml_of(const SegmentOptions& options, int label) {
  return fmt::format("{{method: {}, pick: indices, indices: [{}]}}",
                     options.method == Method::kmeans ? "kmeans" : "grabcut", label);
}

std::vector<SegmentInfo> segments_of(const Labels& labels, const Image8& rgb, const Image8& shape) {
  const auto count = at(1 + *std::max_element(labels.data().begin(), labels.data().end()));
  std::vector<SegmentInfo> segments(count);
  std::vector<std::array<double, 5>> sums(count, std::array<double, 5>{});  // r, g, b, pixels, object pixels
  std::vector<float> deepest(count, -1);
  const cv::Mat depth = depth_inside(labels);
  for (int y = 0; y < labels.height(); ++y)
    for (int x = 0; x < labels.width(); ++x) {
      const std::size_t i = at(labels.at(x, y));
      SegmentInfo& s = segments[i];
      if (sums[i][3] == 0) s.box_px = {x, y, x, y};  // corners for now
      s.box_px[0] = std::min(s.box_px[0], x);
      s.box_px[2] = std::max(s.box_px[2], x);
      s.box_px[3] = y;
      for (std::size_t c = 0; c < 3; ++c) sums[i][c] += rgb.at(x, y, static_cast<int>(c));
      sums[i][3] += 1;
      if (shape.at(x, y) == stencil::object) sums[i][4] += 1;
      if (depth.at<float>(y + 1, x + 1) <= deepest[i]) continue;
      deepest[i] = depth.at<float>(y + 1, x + 1);
      s.inside_px = {x, y};
    }
  for (std::size_t i = 0; i < count; ++i) {
    SegmentInfo& s = segments[i];
    s.label = static_cast<int>(i);
    s.area_percent = 100 * sums[i][3] / static_cast<double>(labels.data().size());
    s.box_px = {s.box_px[0], s.box_px[1], s.box_px[2] - s.box_px[0] + 1, s.box_px[3] - s.box_px[1] + 1};
    for (std::size_t c = 0; c < 3; ++c)
      s.mean_color[c] = static_cast<std::uint8_t>(std::lround(sums[i][c] / std::max(1.0, sums[i][3])));
    s.chosen = 2 * sums[i][4] > sums[i][3];
  }
  return segments;
}

Segmentation given_stencil(const Image8& rgb, const Image8& given, const SegmentOptions& options) {
  const bool tri_state = options.method != Method::alpha &&
                         std::all_of(given.data().begin(), given.data().end(), [](std::uint8_t v) {
                           return v == stencil::background || v == stencil::unknown || v == stencil::object;
                         });
  Segmentation out;
  out.stencil = given;
  if (!tri_state)
    for (std::uint8_t& v : out.stencil.data()) v = v > 127 ? stencil::object : stencil::background;
  Labels states(rgb.width(), rgb.height(), 1, 0);
  std::vector<int> names(256, -1);
  int count = 0;
  for (std::size_t i = 0; i < states.data().size(); ++i) {
    int& name = names[out.stencil.data()[i]];
    if (name < 0) name = count++;
    states.data()[i] = name;
  }
  out.labels = largest_first(states);
  out.segments = segments_of(out.labels, rgb, out.stencil);
  for (SegmentInfo& s : out.segments)
    s.yaml_that_picks_it = options.method == Method::alpha ? "{method: alpha}" : "{method: mask}";
  const bool any = names[stencil::object] >= 0;
  out.confidence = any ? 1 : 0;
  out.how = any ? "the given mask" : "the given mask has no object pixel";
  return out;
}

std::string words_for(const SegmentOptions& options, const PhotoRegion& region, const Segmentation& found) {
  const auto chosen = std::count_if(found.segments.begin(), found.segments.end(),
                                    [](const SegmentInfo& s) { return s.chosen; });
  std::string pick = "by contrast with the border";
  if (region.click_px) pick = "by the click";
  if (region.box_px) pick = region.click_px ? "by the box and the click" : "by the box";
  if (options.pick == Pick::segment) pick = "the one under the click";
  if (options.pick == Pick::indices) pick = "by number";
  const bool empty = std::none_of(found.stencil.data().begin(), found.stencil.data().end(),
                                  [](std::uint8_t v) { return v == stencil::object; });
  if (empty) return fmt::format("nothing stands out among {} segments", found.segments.size());
  return fmt::format("{}: {} of {} segments, picked {}",
                     options.method == Method::kmeans ? "k-means" : "k-means and GrabCut", chosen,
                     found.segments.size(), pick);
}

}  // namespace

Segmentation segment_photo(const Image8& rgb, const Image8& mask_or_alpha, const PhotoRegion& given_region,
                           const SegmentOptions& options, std::uint64_t seed, const Progress& progress) {
  check(rgb, mask_or_alpha, given_region, options);
  const bool given = options.method == Method::mask || options.method == Method::alpha ||
                     (options.method == Method::automatic && !mask_or_alpha.empty());
  if (given) return given_stencil(rgb, mask_or_alpha, options);

  PhotoRegion region = given_region;
  if (options.pick == Pick::box) region.click_px.reset();
  if (options.pick == Pick::click) region.box_px.reset();

  progress.update(0, "finding segments");
  Reduced r;
  r.rgb = reduced(rgb, options.max_side_px);
  r.lab = lab_image(r.rgb);
  r.hints = hints_of(region, rgb, r.rgb);
  const Labels clusters =
      kmeans_clusters(r.lab, options.clusters, options.position_weight, item_seed(seed, 0));
  r.labels = largest_first(merged_regions(connected_regions(clusters), r.lab,
                                          least_segment_share * r.rgb.width() * r.rgb.height(),
                                          least_segment_difference));
  progress.update(0.4, "picking the object");
  r.evidence = evidence_of(r, item_seed(seed, 2));
  r.threshold = otsu_threshold(r.evidence);
  const std::vector<std::uint8_t> picked = picked_segments(r, options);

  progress.update(0.6, "outlining");
  Segmentation out;
  out.labels = refined_labels(r.labels, r.lab, rgb);
  const Image8 raw = options.method == Method::kmeans
                         ? union_of(out.labels, picked)
                         : grabcut_stencil(r, rgb, picked, options, item_seed(seed, 1));
  std::optional<std::array<int, 2>> click;
  if (region.click_px)
    click = {clamped((*region.click_px)[0], rgb.width() - 1),
             clamped((*region.click_px)[1], rgb.height() - 1)};
  out.stencil = shaped(raw, options, click);
  progress.update(0.9, "describing the segments");
  out.segments = segments_of(out.labels, rgb, out.stencil);
  for (SegmentInfo& s : out.segments) s.yaml_that_picks_it = yaml_of(options, s.label);
  out.confidence = confidence_of(out.stencil, r);
  out.how = words_for(options, region, out);
  progress.update(1);
  return out;
}

}  // namespace drape::segmentation
