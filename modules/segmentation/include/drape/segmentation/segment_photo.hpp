// A photo cut into segments, and the ones that show the object as an image stencil.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drape/base/options.hpp"
#include "drape/base/progress.hpp"
#include "drape/geometry/image.hpp"

namespace drape::segmentation {

enum class Method {
  automatic,      // the given mask or alpha if there is one, else background where there is a backdrop, else
                  // grabcut
  kmeans,         // segments by k-means; the stencil is a union of them
  divisive,       // the same by splitting clusters,
  agglomerative,  // by merging them,
  em,             // and by a mixture of Gaussians of colour, texture and position
  grabcut,        // segments by k-means; region colours and a minimum cut for the outline
  background,     // what differs from an even backdrop, or from a photo of the empty scene
  mask,           // the given mask, its unknown pixels kept
  alpha,          // the photo's own alpha channel
};

enum class Pick {
  automatic,  // the box or the click of the photo where it has one, else what stands out from the border
  box,        // what stands out from what surrounds the box
  click,      // what hangs together with the clicked point
  segment,    // exactly the one segment under the click
  indices,    // exactly the segments named
};

enum class Holes { keep, close };

struct SegmentOptions {
  Method method = Method::automatic;
  std::optional<int> clusters;
  double position_weight = 0.3;
  int max_side_px = 400;
  Pick pick = Pick::automatic;
  std::vector<double> indices;
  Holes holes = Holes::keep;
  double min_hole_percent = 0.3;
  double min_island_percent = 10;
};

inline void describe(Binder& b, SegmentOptions& o) {
  b.choice(
      "method", o.method,
      {{"auto", Method::automatic},
       {"kmeans", Method::kmeans},
       {"divisive", Method::divisive},
       {"agglomerative", Method::agglomerative},
       {"em", Method::em},
       {"grabcut", Method::grabcut},
       {"background", Method::background},
       {"mask", Method::mask},
       {"alpha", Method::alpha}},
      "how the object is found: as a union of segments by colour and position (kmeans, divisive, "
      "agglomerative) or colour, texture and position (em); by a minimum cut (grabcut); by its difference "
      "from an even backdrop or a photo of the empty scene (background); as given (mask, alpha). auto: the "
      "photo's mask or alpha if it has one, else background where the border is one backdrop, else grabcut");
  b.number("clusters", o.clusters, {1, 64},
           "clusters; auto: the fewest that explain 95 % of the photo's variance; of em, those of the least "
           "description length");
  b.number("position_weight", o.position_weight, {0, 10},
           "1: across the photo counts as much as black against white; 0: colour alone");
  b.number("max_side_px", o.max_side_px, {16, 4096},
           "segments are found on the photo reduced to this, then outlined at full resolution");
  b.choice(
      "pick", o.pick,
      {{"auto", Pick::automatic},
       {"box", Pick::box},
       {"click", Pick::click},
       {"segment", Pick::segment},
       {"indices", Pick::indices}},
      "which segments are the object; auto: by the photo's box_px or click_px if given, else by contrast "
      "with the border; segment: only the one under click_px; indices: those listed");
  b.numbers("indices", o.indices, 0, {0, 1e6}, "for pick: indices, the labels of segments.json");
  b.choice("holes", o.holes, {{"keep", Holes::keep}, {"close", Holes::close}},
           "holes of the stencil: keep those over min_hole_percent, or close all");
  b.number("min_hole_percent", o.min_hole_percent, {0, 100},
           "smaller holes are closed; percent of the stencil's area");
  b.number("min_island_percent", o.min_island_percent, {0, 100},
           "smaller separate parts are dropped; percent of the largest part's area");
}

/// What the user says of one photo, in its upright pixels (origin at the top left corner).
struct PhotoRegion {
  std::optional<std::array<double, 4>> box_px;    // x, y, width, height round the object, some margin allowed
  std::optional<std::array<double, 2>> click_px;  // a point inside the object
  Image8 scribbles{};    // as large as the photo: stencil::object and background where marked, else unknown
  Image8 empty_scene{};  // RGB, as large as the photo: the same view without the object
};

struct SegmentInfo {
  int label = 0;
  double area_percent = 0;                   // of the photo
  std::array<int, 4> box_px{};               // x, y, width, height
  std::array<int, 2> inside_px{};            // a pixel well inside
  std::array<std::uint8_t, 3> mean_color{};  // sRGB
  bool chosen = false;
  std::string yaml_that_picks_it;  // options of the stage, as a YAML flow mapping
};

struct Segmentation {
  Image<std::int32_t> labels;         // as large as the photo; label i is segments[i]
  std::vector<SegmentInfo> segments;  // largest first
  Image8 stencil;  // tri-state, as large as the photo; all background if nothing stands out
  /// 0..1: how far the object's colours stand apart from the rest, times the share of the outline that lies
  /// on an edge of the photo. 1 for a given mask, 0 for an empty stencil.
  double confidence = 0;
  std::string how;  // in words: which method, which pick, how many segments
};

/// `mask_or_alpha`: the photo's mask or alpha channel, or empty; one channel, as large as the photo. A mask
/// of the values 0, 128 and 255 alone is tri-state; of any other picture a value over 127 is object. Equal
/// inputs and `seed` give equal results for any number of threads. A photo in which nothing stands out gives
/// an empty stencil with confidence 0. Error{input}: an empty photo, a mask of another size; Error{config}: a
/// method or pick that lacks its mask, box, click or indices, or has them outside the photo.
///
/// Clusters are those of the thesis (Algorithms 1 to 3: divisive and agglomerative with Ward's distance on
/// superpixels, k-means seeded by k-means++ of Arthur and Vassilvitskii 2007), or of expectation-maximisation
/// on the eight features of Carson et al. (PAMI 2002); their connected parts are the segments. The automatic
/// pick follows the robust background detection of Zhu et al. (CVPR 2014); grabcut is that of Rother et al.
/// (SIGGRAPH 2004).
[[nodiscard]] Segmentation segment_photo(const Image8& rgb, const Image8& mask_or_alpha,
                                         const PhotoRegion& region, const SegmentOptions& options,
                                         std::uint64_t seed, const Progress& progress = {});

/// RGB picture of the labels in distinct colours (golden-angle hues), the chosen segments bright, the others
/// dim.
[[nodiscard]] Image8 paint_labels(const Segmentation& segmentation);

}  // namespace drape::segmentation
