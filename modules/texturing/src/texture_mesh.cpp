#include "drape/texturing/texture_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <set>

#include "atlas.hpp"
#include "coverage_picture.hpp"
#include "delit_photos.hpp"
#include "drape/base/error.hpp"
#include "drape/base/parallel.hpp"
#include "linear_light.hpp"
#include "photo_materials.hpp"
#include "photo_sights.hpp"
#include "unseen_surface.hpp"
#include "usable_pixels.hpp"
#include "view_choice.hpp"
#include "view_colors.hpp"

namespace drape::texturing {
namespace {

constexpr double blend_px = 12;  // how wide photos go over into each other, on each side of a seam
constexpr int padding_px = 4;    // round the charts of an atlas

void check_mesh(const TriangleMesh& mesh, const char* which) {
  const std::string problem = problem_of(mesh);
  if (!problem.empty()) throw input_error("the {} mesh cannot be textured: {}", which, problem);
  if (!(surface_area(mesh) > 0)) throw input_error("the {} mesh cannot be textured: it has no area", which);
}

void check_view(const TextureView& view) {
  const Image8& rgb = view.rgb;
  if (rgb.empty() || rgb.channels() != 3)
    throw input_error("photo {}: needs pixels with 3 channels to be draped", view.name);
  if (rgb.width() != view.camera.width || rgb.height() != view.camera.height)
    throw input_error("photo {}: is {} x {} pixels, but its camera is for {} x {}", view.name, rgb.width(),
                      rgb.height(), view.camera.width, view.camera.height);
  if (const Image16* deep = view.deep_rgb; deep != nullptr && !deep->empty())
    if (deep->width() != rgb.width() || deep->height() != rgb.height() || deep->channels() != 3)
      throw input_error("photo {}: has {} x {} pixels of 16 bits and {} x {} of 8", view.name, deep->width(),
                        deep->height(), rgb.width(), rgb.height());
  const Image8& stencil = view.stencil;
  if (!stencil.empty() &&
      (stencil.width() != rgb.width() || stencil.height() != rgb.height() || stencil.channels() != 1))
    throw input_error("photo {}: its stencil is {} x {} pixels, the photo {} x {}", view.name,
                      stencil.width(), stencil.height(), rgb.width(), rgb.height());
  if (!view.camera.P().allFinite() || view.camera.K.determinant() == 0)
    throw input_error("photo {}: its camera holds numbers that make no camera", view.name);
}

std::string material_name(const std::string& wanted, std::set<std::string>& taken) {
  std::string name;
  for (const char c : wanted) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  if (name.empty()) name = "photo";
  std::string unique = name;
  for (int i = 2; !taken.insert(unique).second; ++i) unique = fmt::format("{}_{}", name, i);
  return unique;
}

// Pixels under the painted surface, over all photos.
struct PixelTally {
  double covered = 0;
  double overhang = 0;
  double background = 0;
};

void tally(const TextureView& view, const Image8& covered, const Image8& trusted, PixelTally& sum) {
  for (int y = 0; y < covered.height(); ++y)
    for (int x = 0; x < covered.width(); ++x) {
      if (covered.at(x, y) == 0) continue;
      sum.covered += 1;
      if (view.stencil.empty() || view.stencil.at(x, y) != stencil::background) continue;
      sum.overhang += 1;
      if (trusted.at(x, y) == trust::full) sum.background += 1;
    }
}

// Everything between the views and the materials.
struct Painting {
  Sights sights;
  PaintedFaces surface;
  std::vector<PhotoColors> colors;  // of the sights
  std::vector<Eigen::Vector3f> exposures;
  std::vector<int> chosen;
  bool atlas = false;
  double ribbon_reach = 0;          // painted surface goes on so far, in its own colours; 0: it does not
  std::vector<VertexBlend> blends;  // of an atlas
  std::vector<VertexGains> gains;
  std::vector<PhotoPixels> photos;     // of the sights
  std::vector<const Image8*> trusted;  // how far their pixels are
};

// Pixels per unit length where photos paint the surface, typically.
double typical_resolution(const PaintedFaces& surface, std::span<const int> chosen) {
  std::vector<double> resolutions;
  for (std::size_t f = 0; f < chosen.size(); ++f)
    if (chosen[f] != no_view) resolutions.push_back(std::sqrt(candidate_of(surface, f, chosen[f]).quality));
  if (resolutions.empty()) return std::numeric_limits<double>::infinity();
  const auto middle = resolutions.begin() + static_cast<std::ptrdiff_t>(resolutions.size() / 2);
  std::nth_element(resolutions.begin(), middle, resolutions.end());
  return std::max(*middle, std::numeric_limits<double>::min());
}

std::vector<std::uint8_t> painted_faces(std::span<const int> chosen) {
  std::vector<std::uint8_t> painted;
  for (const int view : chosen) painted.push_back(view != no_view);
  return painted;
}

Painting painting_of(const TriangleMesh& simplified, const TriangleMesh& full,
                     std::span<const TextureView> views, const TextureOptions& options,
                     const Progress& progress) {
  Painting p;
  p.sights = sights_of(simplified, full, views, options, progress.part(0, 0.4));
  const std::vector<PhotoSight>& sights = p.sights.sights;
  p.surface = split_at_sight(simplified, sights, options.split_px, progress.part(0.4, 0.9));
  p.atlas =
      options.mode == TextureMode::atlas || (options.mode == TextureMode::automatic && sights.size() > 1);
  for (std::size_t i = 0; i < sights.size(); ++i) {
    const TextureView& view = views[p.sights.views[i]];
    p.photos.push_back({&view.rgb, view.deep_rgb, options.color_bits == ColorBits::sixteen});
    p.trusted.push_back(&sights[i].trusted());
  }
  progress.update(0.9, "reading the photos' colours");
  p.colors.resize(sights.size());
  parallel_for(sights.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) p.colors[i] = PhotoColors(p.photos[i], *p.trusted[i]);
  });
  p.exposures.assign(sights.size(), Eigen::Vector3f::Zero());
  if (sights.size() > 1) {
    look_up_colors(p.surface, sights, p.colors);
    const std::vector<Eigen::Vector3f> matched = matched_exposures(p.surface, sights.size());
    apply_exposures(p.surface, matched);
    if (options.level_seams && p.atlas) p.exposures = matched;
    drop_outliers(p.surface);
  }
  progress.update(0.95, "choosing photos");
  p.chosen = chosen_views(p.surface);
  if (!p.atlas) straighten(p.surface, p.chosen, sights);
  drop_hidden(p.surface, sights, p.chosen);
  // Taking the light out asks once more what photos see.
  if (!options.delight)
    for (PhotoSight& sight : p.sights.sights) sight.forget_depth();
  // What the scanner saw itself needs no ribbons.
  if (options.unseen != Unseen::scan_colour || simplified.colors.empty())
    p.ribbon_reach = options.fill_px / typical_resolution(p.surface, p.chosen);
  if (p.ribbon_reach > 0)
    cut_edges(p.surface, p.chosen, ends_of_reach(p.surface.mesh, painted_faces(p.chosen), p.ribbon_reach));
  if (!p.atlas) return p;
  progress.update(0.97, "blending the photos");
  p.blends = blend_weights(p.surface, p.chosen, blend_px);
  progress.update(0.98, "levelling the seams");
  p.gains = options.level_seams
                ? levelling_gains(p.surface, p.chosen, p.blends, sights, p.colors, p.exposures)
                : no_gains(p.surface, p.chosen, p.blends);
  return p;
}

// Mean over the painted faces round each vertex of what their photos show there.
SeenColors seen_colors(const Painting& p) {
  std::vector<Eigen::Vector4f> sums(p.surface.mesh.vertices.size(), Eigen::Vector4f::Zero());
  for (std::size_t f = 0; f < p.chosen.size(); ++f) {
    if (p.chosen[f] == no_view) continue;
    const auto view = static_cast<std::size_t>(p.chosen[f]);
    const Eigen::Array3f factor = p.exposures[view].array().exp();
    for (const std::uint32_t v : p.surface.mesh.faces[f]) {
      const Eigen::Vector2d pixel = p.sights.sights[view].pixel_of(p.surface.mesh.vertices[v]);
      sums[v].head<3>() += (factor * p.colors[view].smooth_at(pixel).array()).matrix();
      sums[v].w() += 1;
    }
  }
  SeenColors seen(sums.size());
  for (std::size_t v = 0; v < sums.size(); ++v)
    if (sums[v].w() > 0) seen[v] = sums[v].head<3>() / sums[v].w();
  return seen;
}

using FaceLists = std::vector<std::vector<std::size_t>>;

// Adds up what the faces are painted with; returns the faces of each sight.
FaceLists count_shares(const Painting& p, TextureResult& result) {
  FaceLists faces_of(p.sights.views.size());
  const double area = surface_area(p.surface.mesh);
  for (std::size_t f = 0; f < p.chosen.size(); ++f) {
    const double percent = 50 * scaled_face_normal(p.surface.mesh, f).norm() / area;
    if (p.chosen[f] == no_view) {
      result.unseen_percent += percent;
      continue;
    }
    const auto v = static_cast<std::size_t>(p.chosen[f]);
    const double full_share = candidate_of(p.surface, f, p.chosen[f]).full_share;
    faces_of[v].push_back(f);
    result.views[p.sights.views[v]].painted_percent += percent;
    result.seen_percent += percent * full_share;
    result.filled_percent += percent * (1 - full_share);
  }
  return faces_of;
}

void add_photo_materials(const Painting& p, const FaceLists& faces_of, std::span<const TextureView> views,
                         const TextureOptions& options, std::set<std::string>& names, TextureResult& result) {
  TexturedMesh& model = result.model;
  for (std::size_t s = 0; s < faces_of.size(); ++s) {
    if (faces_of[s].empty()) continue;
    const std::size_t view = p.sights.views[s];
    const PhotoSight& sight = p.sights.sights[s];
    PhotoMaterial painted = photo_material(
        p.photos[s], *p.trusted[s], triangles_in_photo(model.mesh, faces_of[s], sight), options.fill_px);
    result.views[view].material = static_cast<int>(model.materials.size());
    for (std::size_t i = 0; i < faces_of[s].size(); ++i) {
      model.face_materials[faces_of[s][i]] = static_cast<std::uint32_t>(model.materials.size());
      model.corner_uvs[faces_of[s][i]] = painted.corner_uvs[i];
    }
    Material material;
    material.name = material_name(views[view].name, names);
    material.image = std::move(painted.image);
    material.deep_image = std::move(painted.deep_image);
    model.materials.push_back(std::move(material));
  }
}

void add_atlas(const Painting& p, const TextureOptions& options, std::set<std::string>& names,
               const Progress& progress, TextureResult& result) {
  const AtlasPaint paint{p.surface,
                         p.chosen,
                         p.blends,
                         p.gains,
                         p.sights.sights,
                         p.colors,
                         options.color_bits == ColorBits::sixteen,
                         options.level_seams};
  Atlas atlas = painted_atlas(paint, options.atlas_size_px, padding_px, progress);
  result.texels_per_pixel = atlas.texels_per_pixel;
  result.atlas_used_percent = atlas.used_percent;
  result.model.corner_uvs = std::move(atlas.corner_uvs);
  result.model.face_materials = std::move(atlas.face_pages);
  for (std::size_t i = 0; i < atlas.pages.size(); ++i) {
    Material material;
    material.name = material_name(fmt::format("atlas_{:03}_color", i), names);
    material.image = std::move(atlas.pages[i].color);
    material.deep_image = std::move(atlas.pages[i].deep_color);
    result.model.materials.push_back(std::move(material));
    result.atlas_coverage.push_back(std::move(atlas.pages[i].coverage));
  }
}

void add_coverage(const Painting& p, const FaceLists& faces_of, std::span<const TextureView> views,
                  TextureResult& result) {
  std::vector<PixelTally> tallies(faces_of.size());
  parallel_for(faces_of.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const TextureView& view = views[p.sights.views[s]];
      const PhotoSight& sight = p.sights.sights[s];
      const Image8 covered = covered_pixels(triangles_in_photo(p.surface.mesh, faces_of[s], sight),
                                            view.rgb.width(), view.rgb.height());
      result.coverage[p.sights.views[s]] = coverage_picture(view.rgb, covered, sight.trusted());
      tally(view, covered, sight.trusted(), tallies[s]);
    }
  });
  PixelTally pixels;
  for (const PixelTally& t : tallies) {
    pixels.covered += t.covered;
    pixels.overhang += t.overhang;
    pixels.background += t.background;
  }
  if (pixels.covered == 0) return;
  result.overhang_percent = 100 * pixels.overhang / pixels.covered;
  result.background_texels_percent = 100 * pixels.background / pixels.covered;
}

void add_flat_material(const std::string& name, const std::vector<std::uint8_t>& faces,
                       const Eigen::Vector3f& color, std::set<std::string>& names, TexturedMesh& model) {
  if (std::find(faces.begin(), faces.end(), 1) == faces.end()) return;
  for (std::size_t f = 0; f < faces.size(); ++f)
    if (faces[f] != 0) model.face_materials[f] = static_cast<std::uint32_t>(model.materials.size());
  Material material;
  material.name = material_name(name, names);
  material.flat_color = color;
  model.materials.push_back(std::move(material));
}

// Narrow ribbons beside painted surface go on in its colours.
void add_unseen(const Painting& p, const TextureOptions& options, std::set<std::string>& names,
                TextureResult& result) {
  TexturedMesh& model = result.model;
  const std::vector<std::uint8_t> painted = painted_faces(p.chosen);
  const SeenColors seen = seen_colors(p);
  std::vector<Eigen::Vector3f> colors = unseen_colors(model.mesh, options.unseen, seen);
  result.unseen_in_scan_colour = options.unseen == Unseen::scan_colour && !colors.empty();
  std::vector<std::uint8_t> ribbons(painted.size(), 0);
  if (p.ribbon_reach > 0) ribbons = faces_within_reach(model.mesh, painted, p.ribbon_reach);
  const bool any = std::find(ribbons.begin(), ribbons.end(), 1) != ribbons.end();
  if (any && options.unseen != Unseen::inpaint) {
    if (colors.empty()) colors.assign(model.mesh.vertices.size(), neutral_color);
    const std::vector<Eigen::Vector3f> grown =
        harmonic_colors(model.mesh, seen, linear_from_stored(neutral_color));
    for (std::size_t f = 0; f < ribbons.size(); ++f)
      if (ribbons[f] != 0)
        for (const std::uint32_t v : model.mesh.faces[f]) colors[v] = stored_from_linear(grown[v]);
  }
  std::vector<std::uint8_t> rest;
  const double area = surface_area(model.mesh);
  for (std::size_t f = 0; f < ribbons.size(); ++f) {
    rest.push_back(painted[f] == 0 && ribbons[f] == 0);
    if (ribbons[f] == 0) continue;
    const double percent = 50 * scaled_face_normal(model.mesh, f).norm() / area;
    result.unseen_percent -= percent;
    result.filled_percent += percent;
  }
  result.unseen_percent = std::max(0.0, result.unseen_percent);
  const Eigen::Vector3f flat = colors.empty() ? neutral_color : Eigen::Vector3f::Ones();
  model.mesh.colors = std::move(colors);
  add_flat_material("grown", ribbons, flat, names, model);
  add_flat_material("unseen", rest, flat, names, model);
}

// Everything that is painted, with the colours that the painting has.
TextureResult painted(const Painting& p, std::span<const TextureView> views, const TextureOptions& options,
                      const Progress& progress) {
  TextureResult result;
  result.views.resize(views.size());
  result.coverage.resize(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) result.views[i].camera = views[i].camera;
  result.model.mesh = p.surface.mesh;
  result.model.corner_uvs.assign(p.chosen.size(),
                                 {Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero()});
  result.model.face_materials.assign(p.chosen.size(), 0);
  const FaceLists faces_of = count_shares(p, result);
  std::set<std::string> names;
  if (p.atlas)
    add_atlas(p, options, names, progress, result);
  else
    add_photo_materials(p, faces_of, views, options, names, result);
  progress.update(0.95, "counting what is covered");
  add_coverage(p, faces_of, views, result);
  add_unseen(p, options, names, result);
  return result;
}

// The same surface in the colours of its paint.
void add_albedo(const TriangleMesh& full, std::span<const TextureView> views, const TextureOptions& options,
                const Progress& progress, Painting& p, TextureResult& result) {
  const std::vector<PhotoSight>& sights = p.sights.sights;
  const Delighting delit = delit_photos(full, sights, p.photos, progress.part(0, 0.8));
  for (std::size_t i = 0; i < sights.size(); ++i) {
    p.photos[i].rgb = &delit.photos[i].rgb;
    p.photos[i].deep = &delit.photos[i].deep_rgb;
    p.trusted[i] = &delit.photos[i].trusted;
    p.colors[i] = PhotoColors(p.photos[i], *p.trusted[i]);
    p.exposures[i].setZero();
    result.lamps += delit.lights[i].lamps.size();
  }
  if (p.atlas && options.level_seams)
    p.gains = levelling_gains(p.surface, p.chosen, p.blends, sights, p.colors, p.exposures);
  result.albedo = painted(p, views, options, progress.part(0.8, 1)).model;
  for (Material& material : result.albedo->materials)
    if (const std::size_t at = material.name.rfind("_color"); at != std::string::npos)
      material.name.replace(at, 6, "_albedo");
  result.log_spread_before = delit.spread.before;
  result.log_spread_after = delit.spread.after;
}

}  // namespace

TextureResult texture_mesh(const TriangleMesh& simplified, const TriangleMesh& full,
                           std::span<const TextureView> views, const TextureOptions& options,
                           const Progress& progress) {
  check_mesh(simplified, "simplified");
  check_mesh(full, "full");
  for (const TextureView& view : views) check_view(view);

  const double light_from = options.delight ? 0.5 : 1;
  Painting p = painting_of(simplified, full, views, options, progress.part(0, 0.7 * light_from));
  TextureResult result = painted(p, views, options, progress.part(0.7 * light_from, light_from));
  for (std::size_t s = 0; s < p.sights.views.size(); ++s) {
    result.views[p.sights.views[s]].warp_px = p.sights.warps_px[s];
    result.views[p.sights.views[s]].pose_px = p.sights.poses_px[s];
    result.views[p.sights.views[s]].camera = p.sights.sights[s].camera();
  }
  for (std::size_t i = 0; i < views.size(); ++i)
    if (!views[i].usable)
      result.views[i].reason = "not usable";
    else if (result.views[i].painted_percent == 0)
      result.views[i].reason = "sees nothing of the model that others do not see better";
  if (options.delight && !p.sights.views.empty())
    add_albedo(full, views, options, progress.part(light_from, 1), p, result);
  progress.update(1);
  return result;
}

}  // namespace drape::texturing
