// How much of the light is left in the albedo: simulated objects under area lamps with cast shadows, one
// bounce and a film's tone curve, against their paint.
// Usage: delighting_quality [save=FOLDER] [objects=teapot,statue] [seed=1000] [seeds=2] [option=value ...],
// options as in the `texture` section. Seeds from 1000 on are for reporting; nothing was tuned on them.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "drape/io/photo.hpp"
#include "drape/metrics/image_error.hpp"
#include "drape/rendering/renderer.hpp"
#include "drape/simulation/studio.hpp"
#include "drape/texturing/texture_mesh.hpp"
#include "program_arguments.hpp"

namespace drape {
namespace {

using simulation::ObjectKind;
using simulation::StudioPhoto;

constexpr int width = 640;
constexpr int height = 480;

struct Object {
  std::string name;
  simulation::Subject subject;
  RayCaster caster;
};

Image8 rendered(const TexturedMesh& model, const Camera& camera) {
  rendering::TexturedStyle style;
  style.background = Eigen::Vector3f::Zero();
  style.samples_per_side = 2;  // as the photos and the pictures of the paint are made
  return rendering::render_textured(model, camera, style);
}

// Where the model shows surface painted from photos.
Image8 painted_mask(const TexturedMesh& model, const Camera& camera, const Image8& stencil) {
  TexturedMesh marked = model;
  marked.mesh.colors.clear();
  for (Material& m : marked.materials) {
    m.flat_color = m.image.empty() ? Eigen::Vector3f::Zero() : Eigen::Vector3f::Ones();
    m.image = {};
  }
  const Image8 shown = rendered(marked, camera);
  Image8 mask = stencil;
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x)
      if (shown.at(x, y) != 255) mask.at(x, y) = stencil::background;
  return mask;
}

struct Errors {
  double before = 0;
  double after = 0;
};

// From the photos' own cameras: the model as it was lit, and its albedo.
Errors measure(const Object& object, const std::vector<StudioPhoto>& photos,
               const texturing::TextureOptions& options, const std::string& save) {
  std::vector<texturing::TextureView> views;
  for (const StudioPhoto& photo : photos)
    views.push_back({photo.image, photo.camera, photo.stencil, fmt::format("{:03}_color", views.size())});
  TriangleMesh mesh = object.subject.mesh;
  mesh.colors.clear();
  const texturing::TextureResult result = texturing::texture_mesh(mesh, mesh, views, options);
  Errors errors;
  for (std::size_t i = 0; i < photos.size(); ++i) {
    const StudioPhoto& photo = photos[i];
    const Image8 mask = painted_mask(result.model, photo.camera, photo.stencil);
    const Image8 lit = rendered(result.model, photo.camera);
    const Image8 albedo = rendered(*result.albedo, photo.camera);
    errors.before += metrics::local_albedo_error(lit, photo.paint, mask).value_or(0);
    errors.after += metrics::local_albedo_error(albedo, photo.paint, mask).value_or(0);
    if (save.empty()) continue;
    io::write_image(fmt::format("{}_{}_lit.png", save, i), lit);
    io::write_image(fmt::format("{}_{}_albedo.png", save, i), albedo);
    io::write_image(fmt::format("{}_{}_paint.png", save, i), photo.paint);
  }
  fmt::print("  lamps found {}, log colours of overlapping photos apart {:.3f}, then {:.3f};", result.lamps,
             result.log_spread_before, result.log_spread_after);
  return errors;
}

struct Case {
  const char* name;
  int photos;
  bool own_lights;
};

std::vector<StudioPhoto> photographed(const Object& object, const Case& what, std::uint64_t seed) {
  std::vector<StudioPhoto> photos;
  for (int i = 0; i < what.photos; ++i) {
    const Camera camera =
        simulation::camera_round(object.subject.mesh, width, height, 38,
                                 15.0 + 37.0 * static_cast<double>(seed % 10) + 90 * i, i % 2 == 0 ? 20 : 40);
    simulation::Studio studio = simulation::random_studio(
        object.subject.mesh, what.own_lights ? 100 * seed + static_cast<std::uint64_t>(i) : 100 * seed);
    studio.seed = 100 * seed + static_cast<std::uint64_t>(i);
    photos.push_back(simulation::take_studio_photo(object.subject, object.caster, camera, studio));
  }
  return photos;
}

void run(test::ProgramArguments& arguments) {
  texturing::TextureOptions options;
  std::string folder;
  std::string wanted = "teapot,statue,head,mug,machine_part";
  std::uint64_t first_seed = 1000;
  std::uint64_t seeds = 2;
  if (const auto given = arguments.text("save")) folder = *given;
  if (const auto given = arguments.text("objects")) wanted = *given;
  if (const auto given = arguments.text("seed")) first_seed = std::stoull(*given);
  if (const auto given = arguments.text("seeds")) seeds = std::stoull(*given);
  arguments.read(options);
  arguments.finish();
  options.delight = true;
  const std::vector<Case> cases = {
      {"one photo", 1, false}, {"four photos, one light", 4, false}, {"four photos, four lights", 4, true}};
  std::vector<Errors> sums(cases.size());
  std::vector<double> ratios;
  for (const ObjectKind kind : {ObjectKind::teapot, ObjectKind::statue, ObjectKind::head, ObjectKind::mug,
                                ObjectKind::machine_part}) {
    const std::string name = simulation::object_name(kind);
    if (wanted.find(name) == std::string::npos) continue;
    simulation::Subject subject = simulation::make_subject({kind, 1, 1.5});
    const RayCaster caster(subject.mesh);
    const Object object{name, std::move(subject), caster};
    for (std::uint64_t seed = first_seed; seed < first_seed + seeds; ++seed)
      for (std::size_t c = 0; c < cases.size(); ++c) {
        const std::string save = folder.empty() ? "" : fmt::format("{}/{}_{}_{}", folder, name, seed, c);
        const Errors errors = measure(object, photographed(object, cases[c], seed), options, save);
        sums[c].before += errors.before;
        sums[c].after += errors.after;
        ratios.push_back(errors.after / errors.before);
        fmt::print(" {} seed {} {}: local error {:.4f}, then {:.4f}: {:.0f} %\n", name, seed, cases[c].name,
                   errors.before, errors.after, 100 * ratios.back());
        std::fflush(stdout);
      }
  }
  for (std::size_t c = 0; c < cases.size(); ++c)
    fmt::print("{:26} {:.1f} % of the local error is left\n", cases[c].name,
               100 * sums[c].after / sums[c].before);
  std::sort(ratios.begin(), ratios.end());
  if (!ratios.empty())
    fmt::print("over all cases: median {:.1f} %, worst {:.1f} %\n", 100 * ratios[ratios.size() / 2],
               100 * ratios.back());
}

}  // namespace
}  // namespace drape

int main(int count, char** values) {
  return drape::test::measuring_main(count, values, drape::run);
}
