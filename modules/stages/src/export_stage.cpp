#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "drape/base/files.hpp"
#include "drape/base/log.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/io/camera_sidecars.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/model_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/io/records.hpp"
#include "drape/meshing/simplify.hpp"
#include "drape/report/contact_sheet.hpp"
#include "drape/texturing/normal_maps.hpp"
#include "gltf_axes.hpp"
#include "rows.hpp"

namespace drape::stages {
namespace {

enum class ExportUnits { input, metres, millimetres };
enum class TextureFormat { png, jpeg };

struct ExportOptions {
  bool glb = true;
  bool obj = true;
  bool ply = true;
  bool colored_ply = false;
  bool stl = false;
  bool colmap = false;
  bool meshlab = false;
  bool metashape = false;
  ExportUnits units = ExportUnits::input;
  bool unlit = true;
  bool normal_maps = true;
  TextureFormat glb_textures = TextureFormat::png;
  int web_triangles = 30'000;
};

void describe(Binder& b, ExportOptions& o) {
  b.flag("glb", o.glb, "write model.glb (glTF 2.0): metres, y up, about a local origin");
  b.flag("obj", o.obj,
         "write model.obj with model.mtl and its pictures (PNG; TIFF with texture.color_bits: 16)");
  b.flag("ply", o.ply, "write model.ply with texture coordinates");
  b.flag("colored_ply", o.colored_ply, "write model_colors.ply: a colour per vertex and no pictures");
  b.flag("stl", o.stl, "write model.stl: the shape alone");
  b.flag("colmap", o.colmap, "write the cameras as COLMAP's text files into colmap/");
  b.flag("meshlab", o.meshlab, "write model.mlp: a MeshLab project with the photos as rasters");
  b.flag("metashape", o.metashape, "write metashape.xml: the cameras as Metashape imports them");
  b.choice("units", o.units,
           {{"input", ExportUnits::input}, {"m", ExportUnits::metres}, {"mm", ExportUnits::millimetres}},
           "units of all files but the GLB; input: those of the scans, so that the model lies over them");
  b.flag("unlit", o.unlit, "GLB: viewers show the photo's own light and add none (KHR_materials_unlit)");
  b.flag("normal_maps", o.normal_maps,
         "GLB that viewers light (unlit: false, and model_albedo.glb): the shape of the full mesh as normal "
         "maps, so that the fewer "
         "triangles look like it");
  b.choice("glb_textures", o.glb_textures, {{"png", TextureFormat::png}, {"jpeg", TextureFormat::jpeg}},
           "GLB, whose pictures have 8 bits a channel: PNG keeps every texel, JPEG is smaller");
  b.number(
      "web_triangles", o.web_triangles, {0, 10e6},
      "write model_web.glb, a light copy of about so many triangles and with JPEG textures of 2048 pixels "
      "at the most: the report shows it; 0: none, and the report has no view in three dimensions");
}

// The model without the photos' light, where `texture` took it out.
std::optional<TexturedMesh> load_albedo(const pipeline::StageRun& run) {
  if (!run.has_artifact("texture", "model_albedo.ply")) return std::nullopt;
  const std::filesystem::path file = run.artifact("texture", "model_albedo.ply");
  return io::read_textured_ply(file, file.parent_path() / "textures");
}

// Without photos the model is the mesh itself, in one flat material that leaves its own colours to it.
TexturedMesh load_model(const pipeline::StageRun& run) {
  if (run.has_artifact("texture", "model.ply")) {
    const std::filesystem::path file = run.artifact("texture", "model.ply");
    return io::read_textured_ply(file, file.parent_path() / "textures");
  }
  TexturedMesh model;
  model.mesh = io::read_mesh(run.artifact("fill", "mesh_simplified.ply"));
  Material material;
  material.name = "surface";
  if (model.mesh.colors.empty()) material.flat_color = Eigen::Vector3f(0.75F, 0.75F, 0.75F);
  model.materials.push_back(std::move(material));
  model.face_materials.assign(model.mesh.faces.size(), 0);
  model.corner_uvs.assign(model.mesh.faces.size(),
                          {Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero()});
  return model;
}

// From the workspace's frame to glTF's: y up, about the middle of the model.
struct GltfFrame {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // y up too, in the world
};

GltfFrame gltf_frame(const TexturedMesh& model, const io::WorkspaceFrame& frame, char up) {
  const BoundingBox box = bounding_box(model.mesh.vertices);
  const Eigen::Vector3d origin = box.isEmpty() ? Eigen::Vector3d::Zero() : Eigen::Vector3d(box.center());
  const Eigen::Matrix3d rotation = y_up_from(up);
  GltfFrame result;
  result.transform.linear() = rotation;
  result.transform.translation() = -(rotation * origin);
  result.origin = rotation * (origin + frame.world_offset_m);
  return result;
}

// What simplification took away, where a viewer's light can show it: pictures have normals to lie beside.
TexturedMesh with_full_shape(const ExportOptions& options, TexturedMesh model, int most_side_px,
                             const pipeline::StageRun& run) {
  const bool pictures = std::any_of(model.materials.begin(), model.materials.end(),
                                    [](const Material& m) { return !m.image.empty(); });
  if (!options.normal_maps || !pictures) return model;
  return texturing::with_normal_maps(std::move(model), io::read_mesh(run.artifact("fill", "mesh.ply")),
                                     most_side_px);
}

void write_web_copy(const ExportOptions& options, const TexturedMesh& model, const GltfFrame& frame,
                    pipeline::StageRun& run) {
  constexpr int most_side_px = 2048;
  constexpr int most_normal_side_px = 1024;
  TexturedMesh light = meshing::simplified(model, static_cast<std::size_t>(options.web_triangles));
  for (Material& material : light.materials)
    if (!material.image.empty()) material.image = report::fitted(material.image, most_side_px, most_side_px);
  if (!options.unlit) light = with_full_shape(options, std::move(light), most_normal_side_px, run);
  io::write_glb(run.output("model_web.glb"), light, frame.transform, frame.origin,
                {.unlit = options.unlit, .jpeg_textures = true, .jpeg_quality = 85});
}

void write_gltf(const ExportOptions& options, const TexturedMesh& model, const io::WorkspaceFrame& frame,
                pipeline::StageRun& run) {
  const GltfFrame gltf = gltf_frame(model, frame, run.input().up);
  io::GlbOptions glb;
  glb.unlit = options.unlit;
  glb.jpeg_textures = options.glb_textures == TextureFormat::jpeg;
  constexpr int most_normal_side_px = 2048;
  if (options.glb)
    io::write_glb(run.output("model.glb"),
                  options.unlit ? model : with_full_shape(options, model, most_normal_side_px, run),
                  gltf.transform, gltf.origin, glb);
  // Paint is for a viewer to light.
  glb.unlit = false;
  if (const auto albedo = load_albedo(run); albedo && options.glb)
    io::write_glb(run.output("model_albedo.glb"), with_full_shape(options, *albedo, most_normal_side_px, run),
                  gltf.transform, gltf.origin, glb);
  if (options.web_triangles > 0) write_web_copy(options, model, gltf, run);
}

io::WorkspaceFrame output_frame(const ExportOptions& options, io::WorkspaceFrame frame) {
  if (options.units == ExportUnits::metres) frame.metres_per_input_unit = 1;
  if (options.units == ExportUnits::millimetres) frame.metres_per_input_unit = 0.001;
  return frame;
}

TexturedMesh in_output_frame(const TexturedMesh& model, const io::WorkspaceFrame& frame) {
  TexturedMesh moved = model;
  for (Eigen::Vector3d& vertex : moved.mesh.vertices) vertex = frame.to_input(vertex);
  return moved;
}

// x_camera = R (x_output * metres per unit - offset) + t, in output units.
std::vector<io::SidecarCamera> cameras_in(const io::WorkspaceFrame& frame, const io::CamerasRecord& record) {
  std::vector<io::SidecarCamera> cameras;
  for (const io::CameraRecord& c : record.cameras) {
    if (c.verdict == io::Verdict::reject) continue;
    io::SidecarCamera sidecar{c.photo, c.camera};
    Rigid3& camera_from_world = sidecar.camera.camera_from_world;
    camera_from_world.translation() =
        (camera_from_world.translation() - camera_from_world.linear() * frame.world_offset_m) /
        frame.metres_per_input_unit;
    cameras.push_back(std::move(sidecar));
  }
  return cameras;
}

// What a format cannot hold is left out with the reason; the model is worth having without it.
void write_sidecars(const ExportOptions& options, const std::vector<io::SidecarCamera>& cameras,
                    pipeline::StageRun& run) {
  const auto holds = [&](io::SidecarFormat format, const std::string& name) {
    for (const io::SidecarCamera& c : cameras) {
      const std::string reason = io::reason_not_held(format, c.camera);
      if (reason.empty()) continue;
      log::warn("export.{}: not written: the camera of {} {}", name, c.photo, reason);
      run.metric(name + "_not_written", c.photo + " " + reason);
      return false;
    }
    return true;
  };
  if (options.colmap && holds(io::SidecarFormat::colmap, "colmap"))
    io::write_colmap(run.output("colmap/cameras.txt").parent_path(), cameras);
  if (options.meshlab && holds(io::SidecarFormat::meshlab, "meshlab"))
    io::write_meshlab_project(run.output("model.mlp"), "model.ply", cameras);
  if (options.metashape && holds(io::SidecarFormat::metashape, "metashape"))
    io::write_metashape_xml(run.output("metashape.xml"), cameras);
}

// Beside the PLY, so that new light finds it.
void write_albedo_ply(const ExportOptions& options, const io::WorkspaceFrame& frame,
                      pipeline::StageRun& run) {
  const auto albedo = load_albedo(run);
  if (!albedo || !options.ply) return;
  std::vector<std::string> pictures;
  for (const Material& material : albedo->materials) {
    pictures.push_back(material.image.empty() ? "" : "model_" + io::picture_name(material));
    if (!material.image.empty()) io::write_picture(run.output(pictures.back()), material);
  }
  io::write_textured_ply(run.output("model_albedo.ply"), in_output_frame(*albedo, frame), pictures);
}

void write_models(const ExportOptions& options, const TexturedMesh& moved, pipeline::StageRun& run) {
  std::vector<std::string> pictures;
  for (const Material& material : moved.materials)
    pictures.push_back(material.image.empty() ? "" : "model_" + io::picture_name(material));
  // The OBJ brings the pictures along; the PLY names the same ones.
  if (options.obj) io::write_obj(run.output("model.obj"), moved);
  if (options.ply) {
    io::write_textured_ply(run.output("model.ply"), moved, pictures);
    if (!options.obj)
      for (std::size_t i = 0; i < pictures.size(); ++i)
        if (!pictures[i].empty()) io::write_picture(run.output(pictures[i]), moved.materials[i]);
  }
  if (options.colored_ply) io::write_mesh_ply(run.output("model_colors.ply"), io::with_vertex_colors(moved));
  if (options.stl) io::write_stl(run.output("model.stl"), moved.mesh);
}

void run(const ExportOptions& options, pipeline::StageRun& run) {
  const TexturedMesh model = load_model(run);
  const io::WorkspaceFrame frame = io::read_holes(run.artifact("fill", "holes.json")).frame;
  write_gltf(options, model, frame, run);
  run.progress().update(0.5);
  const io::WorkspaceFrame target = output_frame(options, frame);
  write_models(options, in_output_frame(model, target), run);
  write_albedo_ply(options, target, run);
  // Those that the texture was made with, where there is one: align's with small corrections.
  const std::string stage = run.has_artifact("texture", "cameras.json") ? "texture" : "align";
  if (run.has_artifact(stage, "cameras.json")) {
    const std::filesystem::path file = run.artifact(stage, "cameras.json");
    write_file(run.output("cameras.json"), read_file(file));
    write_sidecars(options, cameras_in(target, io::read_cameras(file)), run);
  }
  run.metric("vertices", static_cast<double>(model.mesh.vertices.size()));
  run.metric("faces", static_cast<double>(model.mesh.faces.size()));
}

}  // namespace

pipeline::Stage export_stage() {
  pipeline::Stage stage;
  stage.name = "export";
  stage.version = 7;
  stage.summary = "Writes the model in the formats that viewers open; they are copied to `output`.";
  stage.input_parts = {"up"};
  stage.reads = {
      {"fill", "mesh.ply"},          {"fill", "mesh_simplified.ply"}, {"fill", "holes.json"},
      {"texture", "model.ply"},      {"texture", "model_albedo.ply"}, {"texture", "textures/*.png"},
      {"texture", "textures/*.tif"}, {"align", "cameras.json"},       {"texture", "cameras.json"}};
  stage.writes = {"model.glb",    "model_albedo.glb", "model_albedo.ply", "model_web.glb",
                  "model.obj",    "model.mtl",        "model.ply",        "model_*.png",
                  "model_*.tif",  "cameras.json",     "model_colors.ply", "model.stl",
                  "colmap/*.txt", "model.mlp",        "metashape.xml"};
  stage.applies = [](const pipeline::Input&) { return true; };
  stage.published = true;
  stage.instantiate = pipeline::stage_body(run);
  return stage;
}

}  // namespace drape::stages
