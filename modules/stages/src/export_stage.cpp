#include <fmt/core.h>

#include "drape/base/files.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/model_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/io/records.hpp"
#include "rows.hpp"

namespace drape::stages {
namespace {

enum class ExportUnits { input, metres, millimetres };
enum class TextureFormat { png, jpeg };

struct ExportOptions {
  bool glb = true;
  bool obj = true;
  bool ply = true;
  ExportUnits units = ExportUnits::input;
  bool unlit = true;
  TextureFormat glb_textures = TextureFormat::png;
};

void describe(Binder& b, ExportOptions& o) {
  b.flag("glb", o.glb, "write model.glb (glTF 2.0): metres, y up, about a local origin");
  b.flag("obj", o.obj, "write model.obj with model.mtl and its pictures");
  b.flag("ply", o.ply, "write model.ply with texture coordinates");
  b.choice("units", o.units,
           {{"input", ExportUnits::input}, {"m", ExportUnits::metres}, {"mm", ExportUnits::millimetres}},
           "units of the OBJ and the PLY; input: those of the scans, so that the model lies over them");
  b.flag("unlit", o.unlit, "GLB: viewers show the photo's own light and add none (KHR_materials_unlit)");
  b.choice("glb_textures", o.glb_textures, {{"png", TextureFormat::png}, {"jpeg", TextureFormat::jpeg}},
           "GLB: PNG keeps every texel, JPEG is smaller");
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

// glTF is y up: the input's up axis is turned onto +y.
Eigen::Matrix3d y_up_from(char up) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  if (up == 'z') rotation << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  if (up == 'x') rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  return rotation;
}

void write_gltf(const ExportOptions& options, const TexturedMesh& model, const io::WorkspaceFrame& frame,
                pipeline::StageRun& run) {
  const BoundingBox box = bounding_box(model.mesh.vertices);
  const Eigen::Vector3d origin = box.isEmpty() ? Eigen::Vector3d::Zero() : Eigen::Vector3d(box.center());
  const Eigen::Matrix3d rotation = y_up_from(run.input().up);
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  transform.linear() = rotation;
  transform.translation() = -(rotation * origin);
  io::GlbOptions glb;
  glb.unlit = options.unlit;
  glb.jpeg_textures = options.glb_textures == TextureFormat::jpeg;
  io::write_glb(run.output("model.glb"), model, transform, rotation * (origin + frame.world_offset_m), glb);
}

TexturedMesh in_output_units(const ExportOptions& options, const TexturedMesh& model,
                             const io::WorkspaceFrame& frame) {
  io::WorkspaceFrame target = frame;
  if (options.units == ExportUnits::metres) target.metres_per_input_unit = 1;
  if (options.units == ExportUnits::millimetres) target.metres_per_input_unit = 0.001;
  TexturedMesh moved = model;
  for (Eigen::Vector3d& vertex : moved.mesh.vertices) vertex = target.to_input(vertex);
  return moved;
}

void run(const ExportOptions& options, pipeline::StageRun& run) {
  const TexturedMesh model = load_model(run);
  const io::WorkspaceFrame frame = io::read_holes(run.artifact("fill", "holes.json")).frame;
  if (options.glb) write_gltf(options, model, frame, run);
  run.progress().update(0.5);
  if (options.obj || options.ply) {
    const TexturedMesh moved = in_output_units(options, model, frame);
    std::vector<std::string> pictures;
    for (const Material& material : moved.materials)
      pictures.push_back(material.image.empty() ? "" : "model_" + material.name + ".png");
    // The OBJ brings the pictures along; the PLY names the same ones.
    if (options.obj) io::write_obj(run.output("model.obj"), moved);
    if (options.ply) {
      io::write_textured_ply(run.output("model.ply"), moved, pictures);
      if (!options.obj)
        for (std::size_t i = 0; i < pictures.size(); ++i)
          if (!pictures[i].empty()) io::write_image(run.output(pictures[i]), moved.materials[i].image);
    }
  }
  if (run.has_artifact("align", "cameras.json"))
    write_file(run.output("cameras.json"), read_file(run.artifact("align", "cameras.json")));
  run.metric("vertices", static_cast<double>(model.mesh.vertices.size()));
  run.metric("faces", static_cast<double>(model.mesh.faces.size()));
}

}  // namespace

pipeline::Stage export_stage() {
  pipeline::Stage stage;
  stage.name = "export";
  stage.summary = "Writes the model in the formats that viewers open; they are copied to `output`.";
  stage.input_parts = {"up"};
  stage.reads = {{"fill", "mesh_simplified.ply"},
                 {"fill", "holes.json"},
                 {"texture", "model.ply"},
                 {"texture", "textures/*.png"},
                 {"align", "cameras.json"}};
  stage.writes = {"model.glb", "model.obj", "model.mtl", "model.ply", "model_*.png", "cameras.json"};
  stage.applies = [](const pipeline::Input&) { return true; };
  stage.published = true;
  stage.instantiate = pipeline::stage_body(run);
  return stage;
}

}  // namespace drape::stages
