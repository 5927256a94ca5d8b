// The surface on pages of its own, blended from all photos.
#pragma once

#include <span>
#include <vector>

#include "blend_weights.hpp"
#include "charts.hpp"
#include "drape/base/progress.hpp"
#include "drape/geometry/textured_mesh.hpp"
#include "photo_colors.hpp"
#include "seam_levelling.hpp"

namespace drape::texturing {

/// What the pages are painted with.
struct AtlasPaint {
  const PaintedFaces& surface;
  std::span<const int> chosen;
  std::span<const VertexBlend> blends;
  std::span<const VertexGains> gains;
  std::span<const PhotoSight> sights;
  std::span<const PhotoColors> colors;
  bool paint_deep = false;  // in 16 bits a channel, as `colors` then are
  bool match_seams = true;  // texels on both sides of a seam show the same (match_texels_along)
};

struct AtlasPage {
  int side = 0;
  Image8 color;        // RGB, sRGB-encoded, square
  Image16 deep_color;  // the same before it was reduced to 8 bits, where it was painted in 16
  Image8 coverage;  // RGB: one colour per photo, orange where a photo's colours were grown, black elsewhere
};

struct Atlas {
  std::vector<AtlasPage> pages;
  std::vector<std::uint32_t> face_pages;                   // per face; 0 for unpainted ones
  std::vector<std::array<Eigen::Vector2f, 3>> corner_uvs;  // per face; 0 for unpainted ones
  double texels_per_pixel = 1;                             // of the photos, along a line
  double used_percent = 0;                                 // of the pages' texels
};

/// Charts are laid out at the photos' own resolution, made smaller only if they would take more than
/// most_pages pages. Every texel is the mean of its photos in linear light, weighted by `blends`, each
/// corrected by `gains`; texels up to padding_px round a chart go on in its colours.
[[nodiscard]] Atlas painted_atlas(const AtlasPaint& paint, int most_side, int padding_px,
                                  const Progress& progress);

}  // namespace drape::texturing
