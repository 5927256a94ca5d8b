// How simulated objects of a known paint look when draped with photos of it: from cameras that are a little
// off, from cameras that saw nothing, past things in front, across seams.
//
// A held-out view is compared with what that camera takes in: the mean over each pixel's area (3 x 3 rays),
// as the photos that painted the model are means, and without sensor noise, which no model can foretell; the
// photos have theirs. The model is drawn in the same way, with 3 x 3 samples a pixel. Against the held-out
// photo with its noise, and drawn at the pixels' centres, it is printed beside. It is compared where all that
// the model shows there comes from pixels of photos, not from colours grown beyond them. The bound: the paint
// itself, averaged over each texel.
// A view from the true camera is compared with the photo as it would be without background: half of an
// outline's pixel may be background, which no model is to show. Against the photo itself it is printed
// beside. Usage: texture_quality [save=FOLDER] [objects=teapot,statue]
// [rows=recovered,held_out,occlusion,seams] [seed=0] [off_deg=0.4] [off_focal_percent=1] [option=value ...]:
// how far the cameras of `recovered` are off (an outline says nothing of a turn about an axis of revolution,
// as of the vase, and no stage after the aligner can undo it: off_deg=0.02 is its median error); options as
// in the `texture` section; without `objects` or `rows`: all; other seeds look from other sides.
#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "drape/base/random.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/geometry/ray_caster.hpp"
#include "drape/io/photo.hpp"
#include "drape/metrics/image_error.hpp"
#include "drape/rendering/renderer.hpp"
#include "drape/simulation/objects.hpp"
#include "drape/texturing/texture_mesh.hpp"
#include "painted_object.hpp"
#include "painted_scenes.hpp"
#include "program_arguments.hpp"
#include "triangle_raster.hpp"

namespace drape {
namespace {

using lab::byte;
using lab::camera_at;
using lab::CameraError;
using lab::height;
using lab::linear;
using lab::Object;
using lab::Photo;
using lab::photographed;
using lab::Scene;
using lab::seen_by;
using lab::slightly_off;
using lab::turn_deg;
using lab::width;
using lab::without_background;
using simulation::ObjectKind;
using texturing::TextureMode;
using texturing::TextureOptions;
using texturing::TextureResult;
using texturing::TextureView;

TextureView view_of(const Photo& photo, const Camera& camera) {
  return {photo.rgb, camera, photo.stencil, "photo"};
}

Image8 rendered(const TexturedMesh& model, const Camera& camera, int samples = 1) {
  rendering::TexturedStyle style;
  style.background = Eigen::Vector3f::Zero();
  style.samples_per_side = samples;  // 1: the photos' own resolution: more would blur twice
  return rendering::render_textured(model, camera, style);
}

// Where all that it shows is from pixels of photos: neither unseen nor in grown colours, which the coverage
// of the atlas shows in orange.
Image8 seen_mask(const TextureResult& result, const Camera& camera) {
  TexturedMesh marked = result.model;
  marked.mesh.colors.clear();
  for (std::size_t i = 0; i < marked.materials.size(); ++i) {
    Material& m = marked.materials[i];
    m.flat_color = Eigen::Vector3f::Zero();
    if (m.image.empty()) continue;
    const Image8& coverage = result.atlas_coverage.at(i);
    for (int y = 0; y < m.image.height(); ++y)
      for (int x = 0; x < m.image.width(); ++x) {
        const bool grown = coverage.at(x, y, 0) == 255 && coverage.at(x, y, 1) == 140;
        for (int c = 0; c < 3; ++c) m.image.at(x, y, c) = grown ? 0 : 255;
      }
  }
  const Image8 shown = rendered(marked, camera, 3);
  Image8 mask(width, height, 1, stencil::background);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (shown.at(x, y) >= 254) mask.at(x, y) = stencil::object;
  return mask;
}

struct Mean {
  double sum = 0;
  double count = 0;
  double least = std::numeric_limits<double>::infinity();
  void add(double value) {
    sum += value;
    count += 1;
    least = std::min(least, value);
  }
  [[nodiscard]] double mean() const { return sum / count; }
};

// Texels that change with the background are not the object's.
double background_percent(const TextureResult& on_black, const TextureResult& on_white) {
  constexpr int noticeable = 12;
  double all = 0;
  double different = 0;
  for (std::size_t f = 0; f < on_black.model.mesh.faces.size(); ++f) {
    if (!texturing::is_painted(on_black.model, f)) continue;
    const auto& corner = on_black.model.corner_uvs[f];
    const std::uint32_t m = on_black.model.face_materials[f];
    const double area = scaled_face_normal(on_black.model.mesh, f).norm();
    constexpr int n = 4;
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        const double u = (i + 1 / 3.0) / n;
        const double v = (j + 1 / 3.0) / n;
        const Eigen::Vector2d uv = (1 - u - v) * corner[0].cast<double>() + u * corner[1].cast<double>() +
                                   v * corner[2].cast<double>();
        all += area;
        const Eigen::Vector3d difference = texturing::sampled(on_black.model.materials[m].image, uv) -
                                           texturing::sampled(on_white.model.materials[m].image, uv);
        if (difference.cwiseAbs().maxCoeff() > noticeable) different += area;
      }
  }
  return 100 * different / all;
}

void save(const std::string& folder, const std::string& name, const Image8& image) {
  if (!folder.empty()) io::write_image(fmt::format("{}/{}.png", folder, name), image);
}

// Object pixels at least `px` inside the outline: what the border guard has no part in.
Image8 inner(const Image8& stencil, int px) {
  Image8 kept = stencil;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (const auto& [dx, dy] : {std::pair{-px, 0}, {px, 0}, {0, -px}, {0, px}})
        if (!stencil.contains(x + dx, y + dy) || stencil.at(x + dx, y + dy) != stencil::object)
          kept.at(x, y) = stencil::background;
  return kept;
}

// One photo, cameras slightly off: what the outline and the background look like.
void measure_recovered(const Object& object, const TextureOptions& options, const CameraError& error,
                       std::uint64_t seed, const std::string& folder) {
  Mean psnr;
  Mean background;
  Mean warp;
  double exact = 0;
  double exact_inner = 0;
  Mean inside;
  Mean mixed;
  Mean pose;
  const std::array<std::array<double, 2>, 3> sides = {{{-70, 20}, {35, 40}, {160, 5}}};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Camera camera = camera_at(object, sides[i][0] + turn_deg(seed), sides[i][1]);
    const Scene scene = seen_by(object, camera);
    const Photo black = photographed(scene, Eigen::Vector3f::Zero(), 1, i);
    const Photo white = photographed(scene, Eigen::Vector3f::Ones(), 1, i);
    const Camera off = slightly_off(object, camera, error, item_seed(7 + seed, i));
    const auto draped = [&](const Photo& photo, const Camera& by) {
      return texturing::texture_mesh(object.mesh, object.mesh, std::vector<TextureView>{view_of(photo, by)},
                                     options);
    };
    const TextureResult on_black = draped(black, off);
    background.add(background_percent(on_black, draped(white, off)));
    const Image8 again = rendered(on_black.model, camera);
    const Photo pure = photographed(without_background(scene), Eigen::Vector3f::Zero(), 1, i);
    psnr.add(metrics::psnr_db(again, pure.rgb, black.stencil).value_or(0));
    mixed.add(metrics::psnr_db(again, black.rgb, black.stencil).value_or(0));
    warp.add(on_black.views[0].warp_px);
    inside.add(metrics::psnr_db(again, black.rgb, inner(black.stencil, 6)).value_or(0));
    pose.add(on_black.views[0].pose_px);
    const Image8 best = rendered(draped(black, camera).model, camera);
    const auto share = 1 / static_cast<double>(sides.size());
    exact += share * metrics::psnr_db(best, pure.rgb, black.stencil).value_or(0);
    exact_inner += share * metrics::psnr_db(best, black.rgb, inner(black.stencil, 6)).value_or(0);
    save(folder, fmt::format("{}_{}_off", object.name, i), again);
    save(folder, fmt::format("{}_{}_photo", object.name, i), black.rgb);
    save(folder, fmt::format("{}_{}_object_alone", object.name, i), pure.rgb);
    save(folder, fmt::format("{}_{}_coverage", object.name, i), on_black.coverage[0]);
  }
  fmt::print(
      "{:12} camera off by {} deg, {} % focal: background texels {:.3f} %  inside the stencil {:.1f} dB "
      "(worst {:.1f}; with the background in the outline's pixels {:.1f}; 6 px inside {:.1f}; with the true "
      "camera {:.1f} and {:.1f})  pose {:.1f} px  warp "
      "{:.1f} "
      "px\n",
      object.name, error.turn_deg, error.focal_percent, background.mean(), psnr.mean(), psnr.least,
      mixed.mean(), inside.mean(), exact, exact_inner, pose.mean(), warp.mean());
}

// All round, and one more from between the first two.
struct Views {
  std::vector<Scene> four;
  Scene held_out;
};

Views views_of(const Object& object, std::uint64_t seed) {
  Views views;
  for (int i = 0; i < 4; ++i)
    views.four.push_back(
        seen_by(object, camera_at(object, 15 + 90 * i + turn_deg(seed), i % 2 == 0 ? 20 : 40)));
  views.held_out = seen_by(object, camera_at(object, 60 + turn_deg(seed), 30));
  return views;
}

std::vector<Photo> four_photos(const Views& views, bool exposures) {
  std::vector<Photo> photos;
  for (std::size_t i = 0; i < 4; ++i)
    photos.push_back(photographed(views.four[i], Eigen::Vector3f::Zero(),
                                  exposures ? std::array{1.0, 0.7, 0.9, 0.6}[i] : 1, i));
  return photos;
}

TextureResult draped(const Object& object, const std::vector<Photo>& photos, const TextureOptions& options) {
  std::vector<TextureView> views;
  for (const Photo& photo : photos) views.push_back(view_of(photo, photo.camera));
  return texturing::texture_mesh(object.mesh, object.mesh, views, options);
}

// The model with the paint itself in its texels, averaged over each: what no baking can beat at this density.
TexturedMesh truly_painted(const Object& object, TexturedMesh model) {
  constexpr int n = 3;
  std::vector<Image8> done;
  for (const Material& m : model.materials) done.emplace_back(m.image.width(), m.image.height(), 1, 0);
  for (const double margin : {0.0, 1.5})
    for (std::size_t f = 0; f < model.mesh.faces.size(); ++f) {
      const std::uint32_t material = model.face_materials[f];
      Image8& image = model.materials[material].image;
      if (image.empty()) continue;
      std::array<Eigen::Vector2d, 3> t;
      std::array<Eigen::Vector3d, 3> x;
      for (std::size_t k = 0; k < 3; ++k) {
        t[k] = model.corner_uvs[f][k].cast<double>().cwiseProduct(
            Eigen::Vector2d(image.width(), image.height()));
        x[k] = model.mesh.vertices[model.mesh.faces[f][k]];
      }
      Eigen::Matrix2d across;
      across << t[1] - t[0], t[2] - t[0];
      const Eigen::Matrix2d inverse = across.inverse();
      texturing::for_texels(
          t, margin, {0, 0, image.width(), image.height()}, [&](int px, int py, const Eigen::Vector3d&) {
            if (done[material].at(px, py) != 0) return;
            done[material].at(px, py) = 1;
            Eigen::Vector3f light = Eigen::Vector3f::Zero();
            for (int s = 0; s < n * n; ++s) {
              const Eigen::Vector2d at(px + (s % n + 0.5) / n, py + (s / n + 0.5) / n);
              const Eigen::Vector2d w = inverse * (at - t[0]);
              const Eigen::Vector3d point = x[0] + w[0] * (x[1] - x[0]) + w[1] * (x[2] - x[0]);
              light += simulation::object_color(object.spec, point).unaryExpr(&linear);
            }
            for (int c = 0; c < 3; ++c) image.at(px, py, c) = byte(light[c] / (n * n));
          });
    }
  return model;
}

// Four photos, seen from between them; by their true cameras or by such as are a little off.
void measure_held_out(const Object& object, const Views& views, const TextureOptions& options, bool off,
                      std::uint64_t seed, const std::string& folder) {
  std::vector<Photo> photos = four_photos(views, false);
  for (std::size_t i = 0; off && i < photos.size(); ++i)
    photos[i].camera = slightly_off(object, photos[i].camera, {}, item_seed(11 + seed, i));
  const TextureResult result = draped(object, photos, options);
  const Camera& camera = views.held_out.camera;
  const Photo truth = photographed(views.held_out, Eigen::Vector3f::Zero(), 1, 99);
  const Photo clean = photographed(views.held_out, Eigen::Vector3f::Zero(), 1, 99, 0);
  const Image8 again = rendered(result.model, camera, 3);
  const Image8 at_centers = rendered(result.model, camera);
  const Image8 mask = seen_mask(result, camera);
  double seen = 0;
  double all = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      seen += mask.at(x, y) == stencil::object ? 1 : 0;
      all += truth.stencil.at(x, y) == stencil::object ? 1 : 0;
    }
  const auto likeness = [&](const Image8& made, const Image8& reference) {
    return fmt::format("{:.2f} dB, SSIM {:.4f}", metrics::psnr_db(made, reference, mask).value_or(0),
                       metrics::ssim(made, reference, mask).value_or(0));
  };
  fmt::print(
      "{:12} held-out view of four photos{}: {} on the {:.1f} % that photos saw (with that view's noise {}, "
      "the noise alone {}; drawn at the pixels' centres {}); unseen of the surface {:.1f} %, {} pages, "
      "{:.0f} % "
      "used\n",
      object.name, off ? ", cameras off by 0.4 deg, 1 %" : "", likeness(again, clean.rgb), 100 * seen / all,
      likeness(again, truth.rgb), likeness(clean.rgb, truth.rgb), likeness(at_centers, clean.rgb),
      result.unseen_percent, result.atlas_coverage.size(), result.atlas_used_percent);
  if (off) return;
  const Image8 ideal = rendered(truly_painted(object, result.model), camera, 3);
  fmt::print("{:12}   the paint itself in the same texels: {}\n", object.name, likeness(ideal, clean.rgb));
  save(folder, object.name + "_held_out", again);
  constexpr std::uint8_t not_compared = 40;
  Image8 difference = truth.rgb;
  for (std::size_t i = 0; i < difference.data().size(); ++i)
    difference.data()[i] = mask.data()[i / 3] == stencil::object
                               ? static_cast<std::uint8_t>(std::min(
                                     255, 4 * std::abs(int{again.data()[i]} - int{clean.rgb.data()[i]})))
                               : not_compared;
  save(folder, object.name + "_held_out_difference_x4", difference);
  save(folder, object.name + "_held_out_truth", truth.rgb);
  for (std::size_t i = 0; i < result.atlas_coverage.size(); ++i) {
    save(folder, fmt::format("{}_atlas_{}", object.name, i), result.model.materials[i].image);
    save(folder, fmt::format("{}_atlas_{}_coverage", object.name, i), result.atlas_coverage[i]);
  }
}

// Painted surface that a ray from the camera does not reach, in texels of the photo.
void measure_occlusion(const Object& object, const Views& views, TextureOptions options) {
  options.mode = TextureMode::project;
  const std::vector<Photo> photos = four_photos(views, false);
  const TextureResult result = draped(object, photos, options);
  const double tolerance = 0.004 * bounding_box(object.mesh.vertices).diagonal().norm();
  double through = 0;
  double all = 0;
  for (std::size_t f = 0; f < result.model.mesh.faces.size(); ++f) {
    const std::uint32_t m = result.model.face_materials[f];
    const auto painter = std::find_if(result.views.begin(), result.views.end(),
                                      [&](const auto& v) { return v.material == static_cast<int>(m); });
    if (painter == result.views.end()) continue;
    const Camera& camera = photos[static_cast<std::size_t>(painter - result.views.begin())].camera;
    std::array<Eigen::Vector3d, 3> x;
    std::array<Eigen::Vector2d, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = result.model.mesh.vertices[result.model.mesh.faces[f][k]];
      p[k] = camera.project(x[k]).pixel;
    }
    const Eigen::Vector2d u = p[1] - p[0];
    const Eigen::Vector2d v = p[2] - p[0];
    const double texels = std::abs(u.x() * v.y() - u.y() * v.x()) / 2;
    const Eigen::Vector3d middle = (x[0] + x[1] + x[2]) / 3;
    const Eigen::Vector3d way = middle - camera.center();
    all += texels;
    if (object.caster.blocked(camera.center(), way, 1 - tolerance / way.norm())) through += texels;
  }
  fmt::print("{:12} painted through something in front: {:.1f} of {:.0f} texels\n", object.name, through,
             all);
}

// What photos of one exposure differ by at seams is their noise and resampling: no step.
void measure_seams(const Object& object, const Views& views, TextureOptions options) {
  const double floor =
      texturing::mean_step_across_seams(draped(object, four_photos(views, false), options).model);
  const std::vector<Photo> photos = four_photos(views, true);
  const TextureResult levelled = draped(object, photos, options);
  options.mode = TextureMode::project;
  const TextureResult plain = draped(object, photos, options);
  const double after = texturing::mean_step_across_seams(levelled.model);
  const double before = texturing::mean_step_across_seams(plain.model);
  fmt::print(
      "{:12} exposures 1, 0.7, 0.9, 0.6: step across seams {:.2f} of 255 ({:.2f} with equal exposures), "
      "before "
      "{:.2f}: {:.1f} % is left; {:.1f} % less what equal exposures leave\n",
      object.name, after, floor, before, 100 * after / before,
      100 * std::max(0.0, after - floor) / (before - floor));
}

void run(test::ProgramArguments& arguments) {
  texturing::TextureOptions options;
  std::string folder;
  std::string wanted;
  std::string rows;
  std::uint64_t seed = 0;
  if (const auto given = arguments.text("rows")) rows = *given;
  if (const auto given = arguments.text("save")) folder = *given;
  if (const auto given = arguments.text("objects")) wanted = *given;
  if (const auto given = arguments.text("seed")) seed = std::stoull(*given);
  lab::CameraError error;
  if (const auto given = arguments.text("off_deg")) error.turn_deg = std::stod(*given);
  if (const auto given = arguments.text("off_focal_percent")) error.focal_percent = std::stod(*given);
  arguments.read(options);
  arguments.finish();
  for (const ObjectKind kind : {ObjectKind::teapot, ObjectKind::statue, ObjectKind::head,
                                ObjectKind::machine_part, ObjectKind::aircraft, ObjectKind::vase,
                                ObjectKind::chair, ObjectKind::mug, ObjectKind::apple, ObjectKind::books}) {
    const std::string name = simulation::object_name(kind);
    if (!wanted.empty() && wanted.find(name) == std::string::npos) continue;
    const simulation::ObjectSpec spec{kind, 1, 1.5};
    TriangleMesh mesh = simulation::make_object(spec);
    mesh.colors.clear();  // unseen surface is not to help
    const RayCaster caster(mesh);
    const Object object{name, spec, std::move(mesh), caster};
    const auto asked = [&](const char* row) { return rows.empty() || rows.find(row) != std::string::npos; };
    if (asked("recovered")) measure_recovered(object, options, error, seed, folder);
    if (!asked("held_out") && !asked("occlusion") && !asked("seams")) continue;
    const Views views = views_of(object, seed);
    if (asked("held_out")) measure_held_out(object, views, options, false, seed, folder);
    if (asked("held_out")) measure_held_out(object, views, options, true, seed, folder);
    if (asked("occlusion")) measure_occlusion(object, views, options);
    if (asked("seams")) measure_seams(object, views, options);
  }
}

}  // namespace
}  // namespace drape

int main(int count, char** texts) {
  return drape::test::measuring_main(count, texts, drape::run);
}
