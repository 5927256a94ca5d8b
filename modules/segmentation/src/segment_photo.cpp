#include "drape/segmentation/segment_photo.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "backdrop.hpp"
#include "boundary_refinement.hpp"
#include "clusters.hpp"
#include "drape/base/concurrent.hpp"
#include "drape/base/error.hpp"
#include "drape/base/random.hpp"
#include "evidence.hpp"
#include "grabcut.hpp"
#include "region_graph.hpp"
#include "request.hpp"
#include "segment_description.hpp"
#include "stencil_shape.hpp"

namespace drape::segmentation {
namespace {

constexpr double least_segment_share = 0.001;   // of the photo; smaller specks join a neighbour
constexpr double least_segment_difference = 3;  // Lab; neighbours of nearly one colour are one segment
// Method::automatic takes the backdrop's word where it explains so much of the border and leaves an object of
// a plausible size.
constexpr double least_backdrop_share = 0.9;
constexpr double least_object_share = 0.003;
// What is rough (grass, rock, clutter) is taken for a backdrop only by sheets that hide much of the object,
// and parts that do not hang together are rather other things, or the pattern of a table.
constexpr float roughest_backdrop = 12;  // Lab units
constexpr double least_share_of_one = 0.85;
constexpr double most_object_share = 0.75;

// The photo at working size, and what was found on it.
struct Reduced {
  Image8 rgb;
  ImageF lab;
  Labels labels;  // segments, largest first
  Hints hints;
  ImageF empty_scene;  // Lab; empty if there is no photo of it
  Evidence evidence;
};

std::size_t at(std::int32_t label) {
  return static_cast<std::size_t>(label);
}

// The stencil of these methods is a union of segments; of the others it is cut out of the photo.
bool unites_segments(Method method) {
  return method == Method::kmeans || method == Method::divisive || method == Method::agglomerative ||
         method == Method::em;
}

// Of the pixels that are no backdrop, the share of those that hang together most.
double share_of_largest(const Backdrop& backdrop) {
  Image8 object(backdrop.difference.width(), backdrop.difference.height(), 1, stencil::background);
  double all = 0;
  for (std::size_t i = 0; i < object.data().size(); ++i)
    if (backdrop.difference.data()[i] > 1) {
      object.data()[i] = stencil::object;
      all += 1;
    }
  const Image8 largest = without_islands(object, 1, std::nullopt);
  const auto kept = std::count(largest.data().begin(), largest.data().end(), stencil::object);
  return all > 0 ? static_cast<double>(kept) / all : 0;
}

// Whether a backdrop parts object and surroundings well enough for Method::automatic.
bool trusted(const Backdrop& backdrop) {
  const auto objects = std::count_if(backdrop.difference.data().begin(), backdrop.difference.data().end(),
                                     [](float difference) { return difference > 1; });
  const double share = static_cast<double>(objects) / static_cast<double>(backdrop.difference.data().size());
  const bool plausible = share > least_object_share && share < most_object_share;
  const bool smooth = backdrop.border_share > least_backdrop_share && backdrop.limit <= roughest_backdrop;
  return smooth && plausible && share_of_largest(backdrop) > least_share_of_one;
}

// Nothing where the method, or what Method::automatic stands for, asks for none.
std::optional<Backdrop> backdrop_for(Method method, const ImageF& lab, const ImageF& empty_scene,
                                     const Hints& hints) {
  if (method != Method::background && method != Method::automatic) return std::nullopt;
  if (!empty_scene.empty()) return photographed_backdrop(lab, empty_scene);
  const bool hinted = hints.box || hints.click || !hints.scribbles.empty();
  if (method == Method::automatic && hinted) return std::nullopt;
  Backdrop backdrop = smooth_backdrop(lab);
  if (method == Method::automatic && !trusted(backdrop)) return std::nullopt;
  return backdrop;
}

Labels segments_at_working_size(const Reduced& r, const SegmentOptions& options, std::uint64_t seed) {
  const Labels clusters = clusters_of(r.lab, options, seed);
  return largest_first(merged_regions(connected_regions(clusters), r.lab,
                                      least_segment_share * r.rgb.width() * r.rgb.height(),
                                      least_segment_difference));
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
    sum[at(r.labels.data()[i])] += r.evidence.value.data()[i];
    pixels[at(r.labels.data()[i])] += 1;
  }
  for (std::size_t i = 0; i < count; ++i)
    if (sum[i] > r.evidence.threshold * pixels[i]) picked[i] = 1;
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
  const Image8 shape =
      without_holes(without_islands(raw, options.min_island_percent / 100, click), hole_percent / 100);
  return with_unknown_beside(shape, raw);
}

std::uint8_t state_of(const Evidence& evidence, std::size_t pixel) {
  if (!evidence.unknown.empty() && evidence.unknown.data()[pixel] != 0) return stencil::unknown;
  return evidence.value.data()[pixel] > evidence.threshold ? stencil::object : stencil::background;
}

// The evidence, or the picked segments where they are named, parted at working size by a minimum cut unless
// one has been there or the backdrop did it; outlined on the photo.
Image8 cut_stencil(const Reduced& r, const Image8& photo, const std::vector<std::uint8_t>& picked,
                   const SegmentOptions& options, std::uint64_t seed) {
  const bool exact = options.pick == Pick::indices || options.pick == Pick::segment;
  Image8 guess = union_of(r.labels, picked);
  if (!exact)
    for (std::size_t i = 0; i < guess.data().size(); ++i) guess.data()[i] = state_of(r.evidence, i);
  const bool cut_already = !exact && (r.evidence.is_a_cut || options.method == Method::background);
  const Image8 start = shaped(guess, options, r.hints.click);
  const Image8 cut = cut_already ? start : grabcut(r.rgb, start, r.hints, seed);
  Labels sides(cut.width(), cut.height(), 1, 0);
  std::transform(cut.data().begin(), cut.data().end(), sides.data().begin(),
                 [](std::uint8_t v) { return static_cast<std::int32_t>(v); });
  Image8 outlined(photo.width(), photo.height(), 1);
  const Labels full = refined_labels(sides, r.lab, photo);
  std::transform(full.data().begin(), full.data().end(), outlined.data().begin(),
                 [](std::int32_t v) { return static_cast<std::uint8_t>(v); });
  return outlined;
}

double confidence_of(const Image8& full, const Reduced& r) {
  Image8 small(r.rgb.width(), r.rgb.height(), 1, stencil::background);
  std::array<double, 2> sum{};
  std::array<double, 2> pixels{};
  for (int y = 0; y < small.height(); ++y)
    for (int x = 0; x < small.width(); ++x) {
      const std::uint8_t state = full.at((2 * x + 1) * full.width() / (2 * small.width()),
                                         (2 * y + 1) * full.height() / (2 * small.height()));
      if (state == stencil::unknown) continue;
      small.at(x, y) = state;
      const std::size_t side = state == stencil::object ? 1 : 0;
      sum[side] += r.evidence.value.at(x, y);
      pixels[side] += 1;
    }
  if (pixels[0] == 0 || pixels[1] == 0) return 0;
  return std::clamp(sum[1] / pixels[1] - sum[0] / pixels[0], 0.0, 1.0) * edge_share(small, r.lab);
}

std::string yaml_of(const SegmentOptions& options, int label) {
  return fmt::format("{{method: {}, pick: indices, indices: [{}]}}",
                     unites_segments(options.method) ? clustering_name(options.method) : "grabcut", label);
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

std::string method_words(Method method) {
  switch (method) {
    case Method::kmeans:
      return "k-means";
    case Method::divisive:
      return "divisive clustering";
    case Method::agglomerative:
      return "agglomerative clustering";
    case Method::em:
      return "expectation-maximisation";
    case Method::background:
      return "difference from the background";
    default:
      return "k-means and GrabCut";
  }
}

std::string words_for(const SegmentOptions& options, const PhotoRegion& region, const Segmentation& found) {
  const auto chosen = std::count_if(found.segments.begin(), found.segments.end(),
                                    [](const SegmentInfo& s) { return s.chosen; });
  std::string pick = "by contrast with the border";
  if (region.click_px) pick = "by the click";
  if (region.box_px) pick = region.click_px ? "by the box and the click" : "by the box";
  if (!region.scribbles.empty()) pick = "by the scribbles";
  if (options.pick == Pick::segment) pick = "the one under the click";
  if (options.pick == Pick::indices) pick = "by number";
  const bool empty = std::none_of(found.stencil.data().begin(), found.stencil.data().end(),
                                  [](std::uint8_t v) { return v == stencil::object; });
  if (empty) return fmt::format("nothing stands out among {} segments", found.segments.size());
  return fmt::format("{}: {} of {} segments, picked {}", method_words(options.method), chosen,
                     found.segments.size(), pick);
}

Reduced reduced_photo(const Image8& rgb, const PhotoRegion& region, const SegmentOptions& options) {
  Reduced r;
  r.rgb = reduced(rgb, options.max_side_px);
  r.lab = lab_image(r.rgb);
  r.hints = hints_of(region, rgb, r.rgb);
  if (!region.empty_scene.empty())
    r.empty_scene = lab_image(reduced(region.empty_scene, options.max_side_px));
  return r;
}

}  // namespace

Segmentation segment_photo(const Image8& rgb, const Image8& mask_or_alpha, const PhotoRegion& given_region,
                           const SegmentOptions& given_options, std::uint64_t seed,
                           const Progress& progress) {
  SegmentOptions options = given_options;
  check(rgb, mask_or_alpha, given_region, options);
  const bool given = options.method == Method::mask || options.method == Method::alpha ||
                     (options.method == Method::automatic && !mask_or_alpha.empty());
  if (given) return given_stencil(rgb, mask_or_alpha, options);

  PhotoRegion region = given_region;
  if (options.pick == Pick::box) region.click_px.reset();
  if (options.pick == Pick::click) region.box_px.reset();

  progress.update(0, "finding segments");
  Reduced r = reduced_photo(rgb, region, options);
  const std::optional<Backdrop> backdrop = backdrop_for(options.method, r.lab, r.empty_scene, r.hints);
  if (options.method == Method::automatic) options.method = backdrop ? Method::background : Method::grabcut;
  run_concurrently({[&] { r.labels = segments_at_working_size(r, options, item_seed(seed, 0)); },
                    [&] { r.evidence = evidence_of(r.rgb, r.lab, backdrop, r.hints, item_seed(seed, 2)); }});
  progress.update(0.4, "picking the object");
  const std::vector<std::uint8_t> picked = picked_segments(r, options);

  progress.update(0.6, "outlining");
  Segmentation out;
  out.labels = refined_labels(r.labels, r.lab, rgb);
  const Image8 raw = unites_segments(options.method)
                         ? union_of(out.labels, picked)
                         : cut_stencil(r, rgb, picked, options, item_seed(seed, 1));
  out.stencil = shaped(raw, options, pixel_of_click(region, rgb));
  progress.update(0.9, "describing the segments");
  out.segments = segments_of(out.labels, rgb, out.stencil);
  for (SegmentInfo& s : out.segments) s.yaml_that_picks_it = yaml_of(options, s.label);
  out.confidence = confidence_of(out.stencil, r);
  out.how = words_for(options, region, out);
  progress.update(1);
  return out;
}

}  // namespace drape::segmentation
