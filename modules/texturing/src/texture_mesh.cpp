#include "drape/texturing/texture_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <set>

#include "coverage_picture.hpp"
#include "drape/base/error.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/rendering/renderer.hpp"
#include "edge_splits.hpp"
#include "grown_photo.hpp"
#include "painted_faces.hpp"
#include "photo_sight.hpp"
#include "usable_pixels.hpp"
#include "view_choice.hpp"

namespace drape::texturing {
namespace {

const Eigen::Vector3f neutral_color(0.62F, 0.62F, 0.6F);
constexpr double straight_px = 0.2;  // how far linear texture coordinates may be from the true projection
constexpr int most_straightenings = 12;
constexpr int filter_margin_px = 8;       // round what is used of a photo, for filters and mip-maps
constexpr double least_tolerance = 1e-5;  // of the mesh's extent

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
  const Image8& stencil = view.stencil;
  if (!stencil.empty() &&
      (stencil.width() != rgb.width() || stencil.height() != rgb.height() || stencil.channels() != 1))
    throw input_error("photo {}: its stencil is {} x {} pixels, the photo {} x {}", view.name,
                      stencil.width(), stencil.height(), rgb.width(), rgb.height());
  if (!view.camera.P().allFinite() || view.camera.K.determinant() == 0)
    throw input_error("photo {}: its camera holds numbers that make no camera", view.name);
}

bool same_surface(const TriangleMesh& a, const TriangleMesh& b) {
  return a.faces == b.faces && a.vertices == b.vertices;
}

// The usable views, as indices, and what each sees.
struct Sights {
  std::vector<std::size_t> views;
  std::vector<PhotoSight> sights;
};

Sights sights_of(const TriangleMesh& simplified, const TriangleMesh& full, std::span<const TextureView> views,
                 const TextureOptions& options, const Progress& progress) {
  Sights out;
  std::optional<rendering::Renderer> full_renderer;
  std::optional<rendering::Renderer> simplified_renderer;
  const double least = least_tolerance * bounding_box(full.vertices).diagonal().norm();
  for (std::size_t i = 0; i < views.size(); ++i) {
    progress.update(static_cast<double>(i) / static_cast<double>(views.size()),
                    "drawing what the photos see");
    if (!views[i].usable) continue;
    if (!full_renderer) full_renderer.emplace(full);
    const Camera camera = depth_camera(views[i].camera);
    rendering::DepthMap map = full_renderer->depth_map(camera);
    double tolerance = least;
    if (!same_surface(simplified, full)) {
      if (!simplified_renderer) simplified_renderer.emplace(simplified);
      tolerance =
          std::max(least, surface_deviation(simplified_renderer->depth_map(camera), simplified, map, camera));
    }
    out.views.push_back(i);
    out.sights.emplace_back(views[i].camera, std::move(map.depth),
                            usable_pixels(views[i].stencil, views[i].rgb.width(), views[i].rgb.height(),
                                          options.stencil_erode_px, options.fill_px),
                            tolerance, options.max_incidence_deg);
  }
  return out;
}

// Halves edges until the middle of each, in the photo, lies where linear texture coordinates put it.
void straighten(PaintedFaces& surface, std::vector<int>& chosen, const Sights& sights) {
  for (int round = 0; round < most_straightenings; ++round) {
    std::vector<EdgeSplit> splits;
    for (std::size_t f = 0; f < chosen.size(); ++f) {
      if (chosen[f] == no_view) continue;
      const Camera& camera = sights.sights[static_cast<std::size_t>(chosen[f])].camera();
      if (camera.projection == Camera::Projection::orthographic) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = surface.mesh.faces[f][k];
        const std::uint32_t b = surface.mesh.faces[f][(k + 1) % 3];
        const Eigen::Vector3d& xa = surface.mesh.vertices[a];
        const Eigen::Vector3d& xb = surface.mesh.vertices[b];
        const Eigen::Vector2d linear = (camera.project(xa).pixel + camera.project(xb).pixel) / 2;
        if ((camera.project((xa + xb) / 2).pixel - linear).norm() > straight_px)
          splits.push_back({std::min(a, b), std::max(a, b), 0.5});
      }
    }
    if (splits.empty()) return;
    SplitMesh split = split_edges(surface.mesh, splits);
    std::vector<int> views;
    std::vector<std::uint32_t> sets;
    for (const std::uint32_t parent : split.parents) {
      views.push_back(chosen[parent]);
      sets.push_back(surface.candidate_sets[parent]);
    }
    surface.mesh = std::move(split.mesh);
    surface.candidate_sets = std::move(sets);
    chosen = std::move(views);
  }
}

std::string material_name(const std::string& wanted, std::set<std::string>& taken) {
  std::string name;
  for (const char c : wanted) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  if (name.empty()) name = "photo";
  std::string unique = name;
  for (int i = 2; !taken.insert(unique).second; ++i) unique = fmt::format("{}_{}", name, i);
  return unique;
}

// The pixels that the triangles use, with room for filters and for what their colours grow from.
PixelBox used_box(const std::vector<PixelTriangle>& triangles, int width, int height, double fill_px) {
  Eigen::AlignedBox2d box;
  for (const PixelTriangle& t : triangles)
    for (const Eigen::Vector2d& p : t) box.extend(p);
  const double margin = filter_margin_px + std::ceil(fill_px);
  return {std::max(0, static_cast<int>(std::floor(box.min().x() - margin))),
          std::max(0, static_cast<int>(std::floor(box.min().y() - margin))),
          std::min(width, static_cast<int>(std::ceil(box.max().x() + margin))),
          std::min(height, static_cast<int>(std::ceil(box.max().y() + margin)))};
}

// Pixels under the painted surface, over all photos.
struct PixelTally {
  double covered = 0;
  double overhang = 0;
  double background = 0;
};

void tally(const TextureView& view, const Image8& covered, const Image8& material, const PixelBox& box,
           const Image8& trusted, PixelTally& sum) {
  for (int y = 0; y < covered.height(); ++y)
    for (int x = 0; x < covered.width(); ++x) {
      if (covered.at(x, y) == 0) continue;
      sum.covered += 1;
      if (view.stencil.empty() || view.stencil.at(x, y) != stencil::background) continue;
      sum.overhang += 1;
      const bool as_it_was =
          std::equal(&view.rgb.at(x, y), &view.rgb.at(x, y) + 3, &material.at(x - box.left, y - box.top));
      if (as_it_was && trusted.at(x, y) == trust::full) sum.background += 1;
    }
}

// Paints the faces of one view: its material, their texture coordinates, its coverage.
void drape_view(const TextureView& view, const PhotoSight& sight, const std::vector<std::size_t>& faces,
                const TextureOptions& options, std::set<std::string>& names, TextureResult& result,
                std::size_t index, PixelTally& pixels) {
  const int width = view.rgb.width();
  const int height = view.rgb.height();
  TexturedMesh& model = result.model;
  std::vector<PixelTriangle> triangles;
  for (const std::size_t f : faces) {
    PixelTriangle t;
    for (std::size_t k = 0; k < 3; ++k) {
      t[k] = sight.camera().project(model.mesh.vertices[model.mesh.faces[f][k]]).pixel;
      t[k] = t[k].cwiseMax(Eigen::Vector2d::Zero()).cwiseMin(Eigen::Vector2d(width, height));
    }
    triangles.push_back(t);
  }
  const Image8 covered = covered_pixels(triangles, width, height);
  result.coverage[index] = coverage_picture(view.rgb, covered, sight.trusted());
  if (faces.empty()) return;
  const PixelBox box = used_box(triangles, width, height, options.fill_px);
  const Eigen::Vector2d origin(box.left, box.top);
  const Eigen::Vector2d size(box.width(), box.height());
  result.views[index].material = static_cast<int>(model.materials.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    model.face_materials[faces[i]] = static_cast<std::uint32_t>(model.materials.size());
    for (std::size_t k = 0; k < 3; ++k)
      model.corner_uvs[faces[i]][k] = (triangles[i][k] - origin).cwiseQuotient(size).cast<float>();
  }
  Material material;
  material.name = material_name(view.name, names);
  material.image = grown_photo(view.rgb, sight.trusted(), box);
  tally(view, covered, material.image, box, sight.trusted(), pixels);
  model.materials.push_back(std::move(material));
}

void add_unseen_material(TextureResult& result, const std::vector<std::size_t>& faces, Unseen unseen,
                         std::set<std::string>& names) {
  TriangleMesh& mesh = result.model.mesh;
  if (unseen == Unseen::neutral) mesh.colors.clear();
  if (faces.empty()) return;
  Material material;
  material.name = material_name("unseen", names);
  if (mesh.colors.empty()) material.flat_color = neutral_color;
  result.unseen_in_scan_colour = !mesh.colors.empty();
  for (const std::size_t f : faces)
    result.model.face_materials[f] = static_cast<std::uint32_t>(result.model.materials.size());
  result.model.materials.push_back(std::move(material));
}

}  // namespace

TextureResult texture_mesh(const TriangleMesh& simplified, const TriangleMesh& full,
                           std::span<const TextureView> views, const TextureOptions& options,
                           const Progress& progress) {
  check_mesh(simplified, "simplified");
  check_mesh(full, "full");
  for (const TextureView& view : views) check_view(view);

  const Sights sights = sights_of(simplified, full, views, options, progress.part(0, 0.3));
  PaintedFaces surface = split_at_sight(simplified, sights.sights, options.split_px, progress.part(0.3, 0.7));
  std::vector<int> chosen = chosen_views(surface);
  straighten(surface, chosen, sights);

  TextureResult result;
  result.views.resize(views.size());
  result.coverage.resize(views.size());
  result.model.mesh = surface.mesh;
  result.model.corner_uvs.assign(chosen.size(),
                                 {Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero()});
  result.model.face_materials.assign(chosen.size(), 0);

  std::vector<std::vector<std::size_t>> faces_of(sights.views.size());
  std::vector<std::size_t> unseen;
  const double area = surface_area(surface.mesh);
  for (std::size_t f = 0; f < chosen.size(); ++f) {
    const double percent = 50 * scaled_face_normal(surface.mesh, f).norm() / area;
    if (chosen[f] == no_view) {
      unseen.push_back(f);
      result.unseen_percent += percent;
      continue;
    }
    const auto v = static_cast<std::size_t>(chosen[f]);
    const double full_share = candidate_of(surface, f, chosen[f]).full_share;
    faces_of[v].push_back(f);
    result.views[sights.views[v]].painted_percent += percent;
    result.seen_percent += percent * full_share;
    result.filled_percent += percent * (1 - full_share);
  }
  std::set<std::string> names;
  PixelTally pixels;
  for (std::size_t v = 0; v < faces_of.size(); ++v) {
    progress.update(0.7 + 0.3 * static_cast<double>(v) / static_cast<double>(faces_of.size()), "painting");
    drape_view(views[sights.views[v]], sights.sights[v], faces_of[v], options, names, result, sights.views[v],
               pixels);
  }
  for (std::size_t i = 0; i < views.size(); ++i)
    if (!views[i].usable)
      result.views[i].reason = "not usable";
    else if (result.views[i].material < 0)
      result.views[i].reason = "sees nothing of the model that others do not see better";
  if (pixels.covered > 0) {
    result.overhang_percent = 100 * pixels.overhang / pixels.covered;
    result.background_texels_percent = 100 * pixels.background / pixels.covered;
  }
  add_unseen_material(result, unseen, options.unseen, names);
  progress.update(1);
  return result;
}

}  // namespace drape::texturing
