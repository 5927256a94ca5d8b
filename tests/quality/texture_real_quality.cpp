// How a photo draped by its true camera looks again from that camera: PSNR, shares of the surface, time.
// Usage: texture_real_quality [save=FOLDER] [option=value ...], options as in the `texture` section.
#include <fmt/core.h>

#include <Eigen/Geometry>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "drape/base/files.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/rendering/renderer.hpp"
#include "drape/texturing/texture_mesh.hpp"
#include "program_arguments.hpp"
#include "support.hpp"

namespace drape {
namespace {

Camera true_camera(const nlohmann::json& item, int width, int height) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      camera.K(r, c) = item["K"][r][c];
      camera.camera_from_world.linear()(r, c) = item["R"][r][c];
    }
    camera.camera_from_world.translation()[r] = item["t"][r];
  }
  camera.K(0, 2) += 0.5;  // pixel centres are at integers in that file
  camera.K(1, 2) += 0.5;
  return camera;
}

double peak_ratio_db(const Image8& a, const Image8& b, const Image8& where) {
  double squares = 0;
  double count = 0;
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x) {
      if (where.at(x, y) != stencil::object) continue;
      for (int c = 0; c < 3; ++c) {
        const double d = static_cast<double>(a.at(x, y, c)) - b.at(x, y, c);
        squares += d * d;
        count += 1;
      }
    }
  return 10 * std::log10(255 * 255 * count / squares);
}

// The camera carried round the middle of the mesh, about its own upright axis.
Camera turned(const Camera& camera, const TriangleMesh& mesh, double degrees) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& x : mesh.vertices) middle += x / static_cast<double>(mesh.vertices.size());
  const Eigen::Vector3d in_camera = camera.camera_from_world * middle;
  Camera moved = camera;
  const Eigen::AngleAxisd turn(degrees * std::numbers::pi / 180, Eigen::Vector3d::UnitY());
  moved.camera_from_world =
      Eigen::Translation3d(in_camera) * turn * Eigen::Translation3d(-in_camera) * camera.camera_from_world;
  return moved;
}

// Three times as large, about the object: to look at.
Camera close_up(const Camera& camera, const Image8& outline) {
  double x = 0;
  double y = 0;
  double count = 0;
  for (int v = 0; v < outline.height(); ++v)
    for (int u = 0; u < outline.width(); ++u)
      if (outline.at(u, v) == stencil::object) {
        x += u;
        y += v;
        count += 1;
      }
  Camera close = camera;
  close.K.topRows<2>() *= 3;
  close.K(0, 2) += 320 - 3 * x / count;
  close.K(1, 2) += 320 - 3 * y / count;
  close.width = close.height = 640;
  return close;
}

void measure(const nlohmann::json& item, const texturing::TextureOptions& options,
             const std::string& folder) {
  const TriangleMesh mesh = io::read_mesh(test::data(item["mesh"].get<std::string>()));
  const io::Photo photo = io::read_photo(test::data(item["image"].get<std::string>()));
  const Camera camera = true_camera(item, photo.rgb.width(), photo.rgb.height());
  rendering::Renderer renderer(mesh);
  const Image8 outline = renderer.stencil(camera);
  const auto start = std::chrono::steady_clock::now();
  const auto result = texturing::texture_mesh(
      mesh, mesh, std::vector<texturing::TextureView>{{photo.rgb, camera, outline, "photo"}}, options);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  rendering::TexturedStyle plain;
  plain.samples_per_side = 1;
  const Image8 again = rendering::render_textured(result.model, camera, plain);
  Image8 painted = outline;  // without the unseen material
  TexturedMesh bare = result.model;
  for (Material& m : bare.materials)
    if (m.image.empty()) m.flat_color = Eigen::Vector3f(1, 0, 1);
  bare.mesh.colors.clear();
  const Image8 marked = rendering::render_textured(bare, camera, plain);
  double shown = 0;
  double all = 0;
  for (int y = 0; y < outline.height(); ++y)
    for (int x = 0; x < outline.width(); ++x) {
      if (outline.at(x, y) != stencil::object) continue;
      all += 1;
      if (marked.at(x, y, 0) > 250 && marked.at(x, y, 1) < 5 && marked.at(x, y, 2) > 250)
        painted.at(x, y) = stencil::background;
      else
        shown += 1;
    }
  const std::string id = item["id"];
  fmt::print(
      "{:12} {} -> {} faces  seen {:.1f} filled {:.1f} unseen {:.1f} %  painted in the outline {:.1f} %  "
      "PSNR "
      "{:.1f} dB in the outline, {:.1f} dB where painted  {:.2f} s\n",
      id, mesh.faces.size(), result.model.mesh.faces.size(), result.seen_percent, result.filled_percent,
      result.unseen_percent, 100 * shown / all, peak_ratio_db(again, photo.rgb, outline),
      peak_ratio_db(again, photo.rgb, painted), seconds);
  if (folder.empty()) return;
  const Camera close = close_up(camera, outline);
  for (const int degrees : {0, 30, -30})
    io::write_image(fmt::format("{}/{}_{}.png", folder, id, degrees),
                    rendering::render_textured(result.model, turned(close, mesh, degrees), {}));
  io::write_image(fmt::format("{}/{}_marked.png", folder, id), rendering::render_textured(bare, close, {}));
  io::write_image(fmt::format("{}/{}_coverage.png", folder, id), result.coverage[0]);
  io::write_image(fmt::format("{}/{}_material.png", folder, id), result.model.materials[0].image);
}

void run(test::ProgramArguments& arguments) {
  if (!test::have_data("photos/lmo")) {
    fmt::print("skipped: needs photos/lmo of DRAPE_TEST_DATA\n");
    return;
  }
  texturing::TextureOptions options;
  std::string folder;
  if (const auto given = arguments.text("save")) folder = *given;
  arguments.read(options);
  arguments.finish();
  const auto poses = nlohmann::json::parse(read_file(test::data("photos/poses.json")));
  for (const auto& item : poses["items"])
    if (item["image"].get<std::string>().find("lmo") != std::string::npos) measure(item, options, folder);
}

}  // namespace
}  // namespace drape

int main(int count, char** texts) {
  return drape::test::measuring_main(count, texts, drape::run);
}
