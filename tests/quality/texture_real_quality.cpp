// How photos draped by their true cameras look again: one photo from its own camera (PSNR, shares of the
// surface, time), and many photos of the dino on its visual hull from the camera of one that was left out.
// Usage: texture_real_quality [save=FOLDER] [lmo=no] [left_out=4] [option=value ...], options as in the
// `texture` section.
#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "drape/base/files.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/metrics/image_error.hpp"
#include "drape/rendering/renderer.hpp"
#include "drape/texturing/texture_mesh.hpp"
#include "program_arguments.hpp"
#include "real_photos.hpp"
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

double luma(const Image8& rgb, int x, int y) {
  return 0.299 * rgb.at(x, y, 0) + 0.587 * rgb.at(x, y, 1) + 0.114 * rgb.at(x, y, 2);
}

// Mean over windows of 11 x 11 pixels that lie wholly in the mask of 1 - NCC (as Waechter et al. 2014 compare
// renderings); windows without contrast of their own count where the other picture has some, as 1.
double mean_one_minus_ncc(const Image8& a, const Image8& b, const Image8& mask) {
  constexpr int reach = 5;
  constexpr double least_deviation = 2;  // of 255: less is noise
  double sum = 0;
  double count = 0;
  for (int y = reach; y + reach < a.height(); y += 2)
    for (int x = reach; x + reach < a.width(); x += 2) {
      double n = 0;
      double sa = 0;
      double sb = 0;
      double saa = 0;
      double sbb = 0;
      double sab = 0;
      for (int v = y - reach; v <= y + reach; ++v)
        for (int u = x - reach; u <= x + reach; ++u) {
          if (mask.at(u, v) != stencil::object) continue;
          const double p = luma(a, u, v);
          const double q = luma(b, u, v);
          n += 1;
          sa += p;
          sb += q;
          saa += p * p;
          sbb += q * q;
          sab += p * q;
        }
      if (n < (2 * reach + 1) * (2 * reach + 1)) continue;
      const double va = saa / n - sa * sa / n / n;
      const double vb = sbb / n - sb * sb / n / n;
      const bool flat_a = va < least_deviation * least_deviation;
      const bool flat_b = vb < least_deviation * least_deviation;
      if (flat_a && flat_b) continue;
      count += 1;
      sum += flat_a || flat_b ? 1 : 1 - (sab / n - sa * sb / n / n) / std::sqrt(va * vb);
    }
  return sum / count;
}

// Pixels of the outline where the model shows surface that photos painted.
Image8 painted_of(const TexturedMesh& model, const Camera& camera, const Image8& outline) {
  rendering::TexturedStyle plain;
  plain.samples_per_side = 1;
  TexturedMesh bare = model;
  for (Material& m : bare.materials) {
    m.flat_color = m.image.empty() ? Eigen::Vector3f::Zero() : Eigen::Vector3f::Ones();
    m.image = {};
  }
  bare.mesh.colors.clear();
  plain.background = Eigen::Vector3f::Zero();
  const Image8 shown = rendering::render_textured(bare, camera, plain);
  Image8 painted = outline;
  for (int y = 0; y < outline.height(); ++y)
    for (int x = 0; x < outline.width(); ++x)
      if (shown.at(x, y) != 255) painted.at(x, y) = stencil::background;
  return painted;
}

double pixels_in(const Image8& mask) {
  double count = 0;
  for (const std::uint8_t v : mask.data()) count += v == stencil::object ? 1 : 0;
  return count;
}

struct Likeness {
  double one_minus_ncc = 0;
  double psnr_db = 0;
  double painted_percent = 0;  // of the outline
  double seconds = 0;
};

// The hull painted by some of the photos and drawn from the place of one.
Likeness likeness_of(const TriangleMesh& hull, const std::vector<lab::Outline>& outlines,
                     const std::vector<Image8>& rgbs, const std::vector<std::size_t>& painters,
                     std::size_t drawn, const texturing::TextureOptions& options, Image8& again) {
  std::vector<texturing::TextureView> views;
  for (const std::size_t i : painters)
    views.push_back({rgbs[i], outlines[i].camera, outlines[i].stencil, fmt::format("{:03}_color", i)});
  const auto start = std::chrono::steady_clock::now();
  const auto result = texturing::texture_mesh(hull, hull, views, options);
  Likeness found;
  found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Camera& camera = outlines[drawn].camera;
  rendering::TexturedStyle style;
  style.samples_per_side = 3;
  again = rendering::render_textured(result.model, camera, style);
  const Image8 seen = painted_of(result.model, camera, outlines[drawn].stencil);
  found.one_minus_ncc = mean_one_minus_ncc(again, rgbs[drawn], seen);
  found.psnr_db = metrics::psnr_db(again, rgbs[drawn], seen).value_or(0);
  found.painted_percent = 100 * pixels_in(seen) / pixels_in(outlines[drawn].stencil);
  return found;
}

// The photo taken nearest to one, from another side.
std::size_t neighbor_of(const std::vector<lab::Outline>& outlines, std::size_t one) {
  std::size_t nearest = one == 0 ? 1 : 0;
  const auto distance = [&](std::size_t i) {
    return (outlines[i].camera.center() - outlines[one].camera.center()).norm();
  };
  for (std::size_t i = 0; i < outlines.size(); ++i)
    if (i != one && distance(i) < distance(nearest)) nearest = i;
  return nearest;
}

// A hull carved from every second photo, painted by the others but one, which is then drawn.
void measure_dino(int left_out, texturing::TextureOptions options, const std::string& folder) {
  options.stencil_erode_px += 3;  // its stencils are larger than it by that much: see dino_stencil()
  const std::vector<lab::PosedPhoto> photos = lab::posed_photos("dino");
  if (photos.empty()) return;
  std::vector<lab::Outline> outlines;
  std::vector<Image8> rgbs;
  std::vector<lab::Outline> painters;
  for (std::size_t i = 0; i < photos.size(); ++i) {
    Image8 rgb = io::read_photo(photos[i].image).rgb;
    lab::Outline outline{photos[i].truth, lab::dino_stencil(rgb)};
    (i % 2 == 0 ? outlines : painters).push_back(std::move(outline));
    if (i % 2 != 0) rgbs.push_back(std::move(rgb));
  }
  const TriangleMesh hull = lab::dino_hull(outlines);
  fmt::print("dino: a hull of {} faces from {} photos, painted by {} others less one\n", hull.faces.size(),
             outlines.size(), painters.size());
  const std::size_t step = std::max<std::size_t>(1, painters.size() / static_cast<std::size_t>(left_out));
  for (std::size_t out = step / 2; out < painters.size(); out += step) {
    std::vector<std::size_t> others;
    for (std::size_t i = 0; i < painters.size(); ++i)
      if (i != out) others.push_back(i);
    Image8 unused;
    Image8 again;
    const std::size_t near = neighbor_of(painters, out);
    const Likeness own = likeness_of(hull, painters, rgbs, {out}, out, options, unused);
    const Likeness next = likeness_of(hull, painters, rgbs, {near}, out, options, unused);
    const Likeness all = likeness_of(hull, painters, rgbs, others, out, options, again);
    const double apart_deg =
        std::acos(std::clamp((painters[out].camera.camera_from_world.linear() *
                              painters[near].camera.camera_from_world.linear().transpose())
                                         .trace() /
                                     2 -
                                 0.5,
                             -1.0, 1.0)) *
        180 / std::numbers::pi;
    fmt::print(
        "dino {:3} left out: 1 - NCC {:.3f}  PSNR {:.1f} dB  painted in the outline {:.1f} %  {:.2f} s; by "
        "its "
        "own photo alone {:.3f}, {:.1f} dB; by the nearest, {:.0f} deg away, {:.3f}, {:.1f} dB\n",
        2 * out + 1, all.one_minus_ncc, all.psnr_db, all.painted_percent, all.seconds, own.one_minus_ncc,
        own.psnr_db, apart_deg, next.one_minus_ncc, next.psnr_db);
    if (folder.empty()) continue;
    io::write_image(fmt::format("{}/dino_{}_drawn.png", folder, 2 * out + 1), again);
    io::write_image(fmt::format("{}/dino_{}_photo.png", folder, 2 * out + 1), rgbs[out]);
  }
}

void run(test::ProgramArguments& arguments) {
  if (!test::have_data("photos/lmo")) {
    fmt::print("skipped: needs photos/lmo of DRAPE_TEST_DATA\n");
    return;
  }
  texturing::TextureOptions options;
  std::string folder;
  if (const auto given = arguments.text("save")) folder = *given;
  const bool lmo = arguments.text("lmo").value_or("yes") != "no";
  const int left_out = arguments.integer("left_out").value_or(4);
  arguments.read(options);
  arguments.finish();
  const auto poses = nlohmann::json::parse(read_file(test::data("photos/poses.json")));
  for (const auto& item : poses["items"])
    if (lmo && item["image"].get<std::string>().find("lmo") != std::string::npos)
      measure(item, options, folder);
  if (left_out > 0) measure_dino(left_out, options, folder);
}

}  // namespace
}  // namespace drape

int main(int count, char** texts) {
  return drape::test::measuring_main(count, texts, drape::run);
}
