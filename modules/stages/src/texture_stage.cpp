#include <algorithm>
#include <cmath>
#include <numbers>

#include "drape/base/log.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/model_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/io/records.hpp"
#include "drape/texturing/texture_mesh.hpp"
#include "rows.hpp"

namespace drape::stages {
namespace {

constexpr double least_texels_per_pixel = 0.5;  // below, it is seen that the photos showed more

// A photo with its final stencil: its pixels live as long as the view that refers to them.
struct LoadedView {
  Image8 rgb;
  Image16 deep_rgb;
  Image8 stencil;
};

// How far the outline may be off where the photo says nothing about it, by what the aligner knows of its own
// error: an angle moves the rim of the object by its radius times the angle, at the most.
double pose_sigma_px(const io::CameraRecord& record, const Image8& stencil) {
  if (!record.sigma) return 0;
  double object = 0;
  for (const std::uint8_t value : stencil.data()) object += value == stencil::object ? 1 : 0;
  const double radius_px = std::sqrt(object / std::numbers::pi);
  const double radians = std::numbers::pi / 180;
  return radius_px * std::hypot(record.sigma->rotation_deg * radians, record.sigma->direction_deg * radians,
                                record.sigma->focal_percent / 100);
}

std::vector<LoadedView> load_views(const io::CamerasRecord& record, bool deep,
                                   const pipeline::StageRun& run) {
  std::vector<LoadedView> views;
  for (std::size_t i = 0; i < record.cameras.size(); ++i) {
    LoadedView& view = views.emplace_back();
    io::Photo photo = io::read_photo(run.input().photos[i].image, deep);
    view.rgb = std::move(photo.rgb);
    view.deep_rgb = std::move(photo.deep_rgb);
    view.stencil = io::read_stencil(run.artifact("align", record.cameras[i].stencil), view.rgb.width(),
                                    view.rgb.height());
  }
  return views;
}

void write_model(const std::string& file, const TexturedMesh& model, pipeline::StageRun& run) {
  std::vector<std::string> names;
  for (const Material& material : model.materials) {
    names.push_back(material.image.empty() ? "" : io::picture_name(material));
    if (!material.image.empty()) io::write_picture(run.output("textures/" + names.back()), material);
  }
  io::write_textured_ply(run.output(file), model, names);
}

void write_pictures(const texturing::TextureResult& result, pipeline::StageRun& run) {
  write_model("model.ply", result.model, run);
  if (result.albedo) write_model("model_albedo.ply", *result.albedo, run);
  for (std::size_t i = 0; i < result.coverage.size(); ++i)
    if (!result.coverage[i].empty())
      io::write_image(run.output("textures/" + three_digits(i) + "_coverage.png"), result.coverage[i]);
  for (std::size_t i = 0; i < result.atlas_coverage.size(); ++i)
    io::write_image(run.output("textures/atlas_" + three_digits(i) + "_coverage.png"),
                    result.atlas_coverage[i]);
}

// What rendering needs in order to lay the model over the photos as they were laid over it.
void write_corrected_cameras(io::CamerasRecord record, const texturing::TextureResult& result,
                             pipeline::StageRun& run) {
  for (std::size_t i = 0; i < record.cameras.size(); ++i) record.cameras[i].camera = result.views[i].camera;
  io::write_cameras(run.output("cameras.json"), record);
}

void run(const texturing::TextureOptions& options, pipeline::StageRun& run) {
  const TriangleMesh full = io::read_mesh(run.artifact("fill", "mesh.ply"));
  const TriangleMesh simplified = io::read_mesh(run.artifact("fill", "mesh_simplified.ply"));
  const io::CamerasRecord record = io::read_cameras(run.artifact("align", "cameras.json"));
  const std::vector<LoadedView> loaded =
      load_views(record, options.color_bits == texturing::ColorBits::sixteen, run);
  std::vector<texturing::TextureView> views;
  for (std::size_t i = 0; i < loaded.size(); ++i)
    views.push_back({loaded[i].rgb, record.cameras[i].camera, loaded[i].stencil, three_digits(i) + "_color",
                     record.cameras[i].verdict != io::Verdict::reject,
                     pose_sigma_px(record.cameras[i], loaded[i].stencil), &loaded[i].deep_rgb});
  const texturing::TextureResult result =
      texturing::texture_mesh(simplified, full, views, options, run.progress());
  const bool any_usable = std::any_of(views.begin(), views.end(), [](const auto& v) { return v.usable; });
  if (any_usable && result.seen_percent + result.filled_percent == 0)
    run.needs_review(
        "no photo sees the mesh, so nothing of it is painted: are cameras and mesh in the same frame and "
        "unit?");
  write_pictures(result, run);
  write_corrected_cameras(record, result, run);
  run.metric("seen_percent", result.seen_percent);
  run.metric("filled_percent", result.filled_percent);
  run.metric("unseen_percent", result.unseen_percent);
  run.metric("background_texels_percent", result.background_texels_percent);
  run.metric("overhang_percent", result.overhang_percent);
  run.metric("faces", static_cast<double>(result.model.mesh.faces.size()));
  if (result.albedo) {
    run.metric("lamps", static_cast<double>(result.lamps));
    run.metric("log_color_spread", result.log_spread_before);
    run.metric("log_albedo_spread", result.log_spread_after);
  }
  if (!result.atlas_coverage.empty()) {
    run.metric("atlas_pages", static_cast<double>(result.atlas_coverage.size()));
    run.metric("atlas_used_percent", result.atlas_used_percent);
    run.metric("texels_per_photo_pixel", result.texels_per_pixel);
    if (result.texels_per_pixel < least_texels_per_pixel)
      log::warn(
          "the atlas has {:.2f} texels for each of the photos' pixels: texture.atlas_size_px: {} is too "
          "small for what they show",
          result.texels_per_pixel, options.atlas_size_px);
  }
  for (std::size_t i = 0; i < result.views.size(); ++i)
    if (result.views[i].warp_px > 0)
      run.metric("photo_" + three_digits(i) + "_warp_px", result.views[i].warp_px);
  for (std::size_t i = 0; i < result.views.size(); ++i)
    if (result.views[i].pose_px > 0)
      run.metric("photo_" + three_digits(i) + "_pose_px", result.views[i].pose_px);
  for (std::size_t i = 0; i < result.views.size(); ++i)
    if (!result.views[i].reason.empty())
      run.metric("photo_" + three_digits(i) + "_not_used", result.views[i].reason);
}

}  // namespace

pipeline::Stage texture_stage() {
  pipeline::Stage stage;
  stage.name = "texture";
  stage.version = 9;
  stage.summary = "Drapes the photos over the mesh: hidden surfaces, borders, unseen parts.";
  stage.input_parts = {"photos"};
  stage.reads = {{"fill", "mesh.ply"},
                 {"fill", "mesh_simplified.ply"},
                 {"align", "cameras.json"},
                 {"align", "*/stencil.png"}};
  stage.writes = {"model.ply", "model_albedo.ply", "cameras.json", "textures/*.png", "textures/*.tif"};
  stage.applies = [](const pipeline::Input& input) { return !input.photos.empty(); };
  stage.instantiate = pipeline::stage_body(run);
  return stage;
}

}  // namespace drape::stages
