#include "atlas.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "atlas_packing.hpp"
#include "drape/base/parallel.hpp"
#include "face_edges.hpp"
#include "linear_light.hpp"
#include "pull_push.hpp"
#include "seam_texels.hpp"
#include "triangle_raster.hpp"
#include "usable_pixels.hpp"
#include "view_choice.hpp"

namespace drape::texturing {
namespace {

constexpr std::size_t most_pages = 12;
constexpr int band_rows = 64;
constexpr double fringe_px =
    1.5;  // texels round a chart that are sampled, not grown: bilinear filters read them

// One photo's part in a face: weights and light factors at its corners.
struct Share {
  int view;
  Eigen::Vector3f weights;
  Eigen::Matrix3f factors;  // column k: of corner k
};
using Shares = std::vector<Share>;

struct PageFace {
  std::uint32_t face;
  FaceTexels texels;  // on the page
  Shares shares;
};

Shares shares_of(const AtlasPaint& paint, std::uint32_t f) {
  Shares shares;
  const Face& face = paint.surface.mesh.faces[f];
  const auto share_of = [&](int view) -> Share& {
    for (Share& s : shares)
      if (s.view == view) return s;
    shares.push_back({view, Eigen::Vector3f::Zero(), Eigen::Matrix3f::Ones()});
    return shares.back();
  };
  for (int k = 0; k < 3; ++k) {
    const VertexBlend& blend = paint.blends[face[static_cast<std::size_t>(k)]];
    if (blend.empty()) share_of(paint.chosen[f]).weights[k] = 1;
    for (const ViewWeight& w : blend) share_of(w.view).weights[k] = w.weight;
  }
  for (Share& s : shares) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float known = 0;
    std::array<const ViewGain*, 3> gains{};
    for (std::size_t k = 0; k < 3; ++k)
      for (const ViewGain& g : paint.gains[face[k]])
        if (g.view == s.view) {
          gains[k] = &g;
          sum += g.gain;
          known += 1;
        }
    // A corner where the photo has no weight has no correction either; any that goes on smoothly will do.
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3f gain =
          gains[k] != nullptr ? gains[k]->gain : Eigen::Vector3f(sum / std::max(1.F, known));
      s.factors.col(static_cast<Eigen::Index>(k)) = gain.array().exp();
    }
  }
  return shares;
}

// The page's picture of so many bits.
template <class Sample>
Image<Sample>& color_of(AtlasPage& page) {
  if constexpr (std::is_same_v<Sample, std::uint8_t>)
    return page.color;
  else
    return page.deep_color;
}

template <class Sample>
class PagePainter {
 public:
  PagePainter(const AtlasPaint& paint, std::vector<PageFace> faces, int side)
      : paint_(paint),
        faces_(std::move(faces)),
        side_(side),
        color_(side, side, 3, 0),
        done_(side, side, 1, 0),
        coverage_(side, side, 3, 0) {
    bands_.resize(static_cast<std::size_t>((side + band_rows - 1) / band_rows));
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const FaceTexels& t = faces_[i].texels;
      const auto [least, most] = std::minmax({t[0].y(), t[1].y(), t[2].y()});
      const auto band = [&](double y) {
        return std::clamp(static_cast<int>(std::floor(y / band_rows)), 0,
                          static_cast<int>(bands_.size()) - 1);
      };
      for (int b = band(least - fringe_px); b <= band(most + fringe_px); ++b)
        bands_[static_cast<std::size_t>(b)].push_back(static_cast<std::uint32_t>(i));
    }
  }

  AtlasPage painted() {
    parallel_for(bands_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        paint_band(static_cast<int>(b), 0);
        paint_band(static_cast<int>(b), fringe_px);
      }
    });
    grow_colors(color_, done_);
    AtlasPage page;
    page.side = side_;
    color_of<Sample>(page) = std::move(color_);
    page.coverage = std::move(coverage_);
    return page;
  }

 private:
  void paint_band(int band, double margin) {
    const TexelBounds bounds{0, band * band_rows, side_, std::min(side_, (band + 1) * band_rows)};
    for (const std::uint32_t i : bands_[static_cast<std::size_t>(band)]) {
      const PageFace& f = faces_[i];
      for_texels(f.texels, margin, bounds, [&](int x, int y, const Eigen::Vector3d& weights) {
        if (done_.at(x, y) != 0) return;
        done_.at(x, y) = 1;
        const Eigen::Vector3f color = color_at(f, weights);
        for (int c = 0; c < 3; ++c) color_.at(x, y, c) = stored_as<Sample>(color[c]);
        if (margin == 0) mark(f, weights, x, y);
      });
    }
  }

  // Texture coordinates are linear over a face, and so is the way from a texel to its point in space.
  [[nodiscard]] Eigen::Vector3d point_of(const PageFace& f, const Eigen::Vector3d& weights) const {
    const TriangleMesh& mesh = paint_.surface.mesh;
    const Face& face = mesh.faces[f.face];
    return weights[0] * mesh.vertices[face[0]] + weights[1] * mesh.vertices[face[1]] +
           weights[2] * mesh.vertices[face[2]];
  }

  [[nodiscard]] Eigen::Vector3f color_at(const PageFace& f, const Eigen::Vector3d& weights) const {
    const Eigen::Vector3d x = point_of(f, weights);
    const Eigen::Vector3f w = weights.cast<float>();
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    float all = 0;
    for (const Share& s : f.shares) {
      const float share = f.shares.size() == 1 ? 1.F : std::max(0.F, s.weights.dot(w));
      if (share <= 0) continue;
      const auto v = static_cast<std::size_t>(s.view);
      sum += share * (s.factors * w).cwiseProduct(paint_.colors[v].at(paint_.sights[v].pixel_of(x)));
      all += share;
    }
    return all > 0 ? Eigen::Vector3f(sum / all) : sum;
  }

  void mark(const PageFace& f, const Eigen::Vector3d& weights, int x, int y) {
    const PhotoSight& sight = paint_.sights[static_cast<std::size_t>(paint_.chosen[f.face])];
    const std::array<std::uint8_t, 3> shown =
        sight.trust_at(sight.pixel_of(point_of(f, weights))) == trust::full
            ? color_of_view(paint_.chosen[f.face])
            : std::array<std::uint8_t, 3>{255, 140, 0};
    for (int c = 0; c < 3; ++c) coverage_.at(x, y, c) = shown[static_cast<std::size_t>(c)];
  }

  // Far from the orange of grown colours, and neighbours in number far from each other.
  static std::array<std::uint8_t, 3> color_of_view(int view) {
    constexpr std::array<std::array<std::uint8_t, 3>, 8> colors = {{{70, 110, 220},
                                                                    {60, 180, 90},
                                                                    {160, 90, 200},
                                                                    {70, 190, 200},
                                                                    {220, 90, 150},
                                                                    {150, 200, 70},
                                                                    {120, 120, 130},
                                                                    {180, 180, 240}}};
    return colors[static_cast<std::size_t>(view) % colors.size()];
  }

  const AtlasPaint& paint_;
  std::vector<PageFace> faces_;
  int side_;
  Image<Sample> color_;
  Image8 done_;  // where it is painted
  Image8 coverage_;
  std::vector<std::vector<std::uint32_t>> bands_;
};

struct Layout {
  std::vector<Chart> charts;
  Packing packing;
  double scale = 1;
};

Layout laid_out(const AtlasPaint& paint, int most_side, int padding) {
  Layout layout;
  for (;; layout.scale *= 0.8) {
    layout.charts = charts_of(paint.surface, paint.chosen, paint.sights, layout.scale, padding, most_side);
    std::vector<Rectangle> rectangles;
    for (const Chart& c : layout.charts) rectangles.push_back({c.width, c.height});
    layout.packing = packed(rectangles, most_side);
    // Thousands of tiny charts may be nothing but padding: smaller ones would not help.
    constexpr double least_scale = 0.01;
    if (layout.packing.sides.size() <= most_pages || layout.scale < least_scale) return layout;
  }
}

// Where the surface goes on at another place of the atlas.
std::vector<Seam> seams_of(const AtlasPaint& paint, const Atlas& atlas) {
  const TriangleMesh& mesh = paint.surface.mesh;
  const auto place_of = [&](std::uint32_t face, std::uint32_t vertex) -> Eigen::Vector2d {
    const Face& f = mesh.faces[face];
    const auto k = static_cast<std::size_t>(std::find(f.begin(), f.end(), vertex) - f.begin());
    return atlas.corner_uvs[face][k].cast<double>() * atlas.pages[atlas.face_pages[face]].side;
  };
  std::vector<Seam> seams;
  for (const FaceEdge& e : face_edges(mesh)) {
    if (paint.chosen[e.first] == no_view || paint.chosen[e.second] == no_view) continue;
    Seam seam;
    for (std::size_t i = 0; i < 2; ++i) {
      const std::uint32_t f = i == 0 ? e.first : e.second;
      seam.sides[i] = {atlas.face_pages[f], place_of(f, e.low), place_of(f, e.high)};
    }
    const auto& [a, b] = seam.sides;
    if (a.page != b.page || a.from != b.from || a.to != b.to) seams.push_back(seam);
  }
  return seams;
}

template <class Sample>
void paint_pages(const AtlasPaint& paint, std::vector<std::vector<PageFace>> faces,
                 const std::vector<int>& sides, const Progress& progress, Atlas& atlas) {
  for (std::size_t page = 0; page < faces.size(); ++page) {
    progress.update(static_cast<double>(page) / static_cast<double>(faces.size()), "painting");
    atlas.pages.push_back(PagePainter<Sample>(paint, std::move(faces[page]), sides[page]).painted());
  }
  if (!paint.match_seams) return;
  std::vector<Image<Sample>*> pages;
  for (AtlasPage& page : atlas.pages) pages.push_back(&color_of<Sample>(page));
  match_texels_along<Sample>(seams_of(paint, atlas), pages);
}

}  // namespace

Atlas painted_atlas(const AtlasPaint& paint, int most_side, int padding_px, const Progress& progress) {
  progress.update(0, "laying out the atlas");
  const Layout layout = laid_out(paint, most_side, padding_px);
  Atlas atlas;
  atlas.face_pages.assign(paint.chosen.size(), 0);
  atlas.corner_uvs.assign(paint.chosen.size(),
                          {Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero()});
  std::vector<std::vector<PageFace>> faces(layout.packing.sides.size());
  double used = 0;
  double all = 0;
  double pixels = 0;
  for (std::size_t c = 0; c < layout.charts.size(); ++c) {
    const Chart& chart = layout.charts[c];
    const Placement& place = layout.packing.placements[c];
    const auto page = static_cast<std::size_t>(place.page);
    const Eigen::Vector2d corner(place.left, place.top);
    used += static_cast<double>(chart.width) * chart.height;
    pixels += static_cast<double>(chart.width) * chart.height / (chart.scale * chart.scale);
    for (std::size_t i = 0; i < chart.faces.size(); ++i) {
      PageFace f{chart.faces[i], chart.texels[i], shares_of(paint, chart.faces[i])};
      for (std::size_t k = 0; k < 3; ++k) {
        f.texels[k] += corner;
        atlas.corner_uvs[f.face][k] = (f.texels[k] / layout.packing.sides[page]).cast<float>();
      }
      atlas.face_pages[f.face] = static_cast<std::uint32_t>(page);
      faces[page].push_back(std::move(f));
    }
  }
  if (paint.paint_deep) {
    paint_pages<std::uint16_t>(paint, std::move(faces), layout.packing.sides, progress.part(0.1, 1), atlas);
    for (AtlasPage& page : atlas.pages) page.color = bytes_from_deep(page.deep_color);
  } else {
    paint_pages<std::uint8_t>(paint, std::move(faces), layout.packing.sides, progress.part(0.1, 1), atlas);
  }
  for (const int side : layout.packing.sides) all += static_cast<double>(side) * side;
  if (pixels > 0) atlas.texels_per_pixel = std::sqrt(used / pixels);
  atlas.used_percent = all > 0 ? 100 * used / all : 0;
  return atlas;
}

}  // namespace drape::texturing
