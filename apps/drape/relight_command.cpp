#include <fmt/core.h>

#include <Eigen/Geometry>
#include <numbers>

#include "commands.hpp"
#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/model_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/rendering/relit.hpp"
#include "drape/report/views.hpp"

namespace drape::app {
namespace {

namespace fs = std::filesystem;

// The textured PLY that is meant, or a plain mesh; with the light taken out where that lies beside it.
fs::path model_file(const fs::path& what) {
  const fs::path file = fs::is_directory(what) ? what / "model.ply" : what;
  const fs::path albedo = file.parent_path() / (file.stem().string() + "_albedo.ply");
  return fs::exists(albedo) ? albedo : file;
}

TexturedMesh plain(TriangleMesh mesh) {
  TexturedMesh model;
  model.mesh = std::move(mesh);
  Material material;
  material.name = "surface";
  if (model.mesh.colors.empty()) material.flat_color = Eigen::Vector3f::Constant(0.75F);
  model.materials.push_back(std::move(material));
  model.face_materials.assign(model.mesh.faces.size(), 0);
  model.corner_uvs.assign(model.mesh.faces.size(),
                          {Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero()});
  return model;
}

// Whether the header has the line that textured PLY files name their pictures in.
bool names_pictures(const fs::path& file) {
  const std::string bytes = read_file(file);
  const std::size_t end = bytes.find("end_header");
  return bytes.substr(0, end == std::string::npos ? 0 : end).find("comment TextureFile") != std::string::npos;
}

TexturedMesh read_model(const fs::path& file) {
  const bool textured = file.extension() == ".ply" && names_pictures(file);
  return textured ? io::read_textured_ply(file, {}) : plain(io::read_mesh(file));
}

// Counter-clockwise seen from above, from the side that is the front; upwards.
Eigen::Vector3d direction(char up, double azimuth_deg, double elevation_deg) {
  const double deg = std::numbers::pi / 180;
  const Eigen::Vector3d axis = up == 'y' ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d front = up == 'y' ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d(0, -1, 0);
  const Eigen::Vector3d level = Eigen::AngleAxisd(azimuth_deg * deg, axis) * front;
  return std::cos(elevation_deg * deg) * level + std::sin(elevation_deg * deg) * axis;
}

}  // namespace

void relight_command(const RelightArguments& arguments) {
  const fs::path file = model_file(arguments.model);
  const TexturedMesh model = read_model(file);
  report::ViewStyle view;
  view.width_px = arguments.size_px;
  view.height_px = arguments.size_px;
  view.up = direction(arguments.up, 0, 90);
  view.front = direction(arguments.up, arguments.view_azimuth_deg, 0);
  view.elevation_deg = arguments.view_elevation_deg;
  const std::vector<Camera> cameras = report::cameras_around(model.mesh.vertices, view);
  if (cameras.empty()) throw input_error("{}: has no surface to shine on", file.string());
  rendering::RelitStyle style;
  style.towards_light = direction(arguments.up, arguments.azimuth_deg, arguments.elevation_deg);
  style.intensity = arguments.intensity;
  style.ambient = arguments.ambient;
  style.softness_deg = arguments.softness_deg;
  const fs::path output = arguments.output.empty()
                              ? file.parent_path() / (file.stem().string() + "-relit.png")
                              : arguments.output;
  io::write_image(output, rendering::render_relit(model, cameras.front(), style));
  fmt::print("{}\n", output.string());
}

}  // namespace drape::app
