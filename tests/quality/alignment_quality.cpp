// How well photos are aligned: stencils of known cameras in, a table out.
//
//   alignment_quality [poses per model] [model.obj ...] [option=value ...]
//
// Models are files of DRAPE_TEST_DATA's meshes/; options are those of `align:`. Poses: any rotation, 20 to 60
// degrees of horizontal field of view, the object off the middle of a 640 x 480 picture and over half to all
// of its height, its stencil without any error.
#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>
#include <string>
#include <vector>

#include "drape/alignment/align.hpp"
#include "drape/alignment/overlap.hpp"
#include "drape/base/numbers.hpp"
#include "drape/base/random.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/metrics/camera_error.hpp"
#include "drape/metrics/distribution.hpp"
#include "drape/rendering/renderer.hpp"
#include "support.hpp"

namespace drape {
namespace {

constexpr int width = 640;
constexpr int height = 480;

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

struct Arguments {
  int poses = 3;
  std::vector<std::string> models;
  alignment::AlignOptions options;
};

Arguments parse(int count, char** texts) {
  Arguments arguments;
  const std::vector<Option> options = options_of(arguments.options);
  for (int i = 1; i < count; ++i) {
    const std::string text = texts[i];
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
      if (const auto poses = parse_integer(text))
        arguments.poses = static_cast<int>(*poses);
      else
        arguments.models.push_back(text);
      continue;
    }
    const auto option = std::find_if(options.begin(), options.end(),
                                     [&](const Option& o) { return o.name == text.substr(0, equals); });
    if (option == options.end()) throw config_error("there is no option {}", text.substr(0, equals));
    const auto value = parse_option(*option, text.substr(equals + 1));
    if (const auto* words = std::get_if<std::string>(&value))
      throw config_error("{} {}", option->name, *words);
    option->assign(std::get<OptionValue>(value));
  }
  if (arguments.models.empty())
    arguments.models = {"teapot.obj", "fandisk.obj", "rocker-arm.obj", "cessna.obj"};
  return arguments;
}

/// Where the object is, how large, and the camera that sees it so.
Camera random_view(const TriangleMesh& mesh, std::uint64_t seed, Camera::Projection projection) {
  Rng rng(seed);
  const BoundingBox box = bounding_box(mesh.vertices);
  double radius = 0;
  for (const Eigen::Vector3d& x : mesh.vertices) radius = std::max(radius, (x - box.center()).norm());
  const Eigen::Quaterniond rotation(rng.normal(), rng.normal(), rng.normal(), rng.normal());
  const double fov = rng.uniform(20, 60) * std::numbers::pi / 180;
  const double size_px = rng.uniform(0.5, 0.9) * height / 2;  // of the radius
  const Eigen::Vector2d place(width / 2.0 + rng.uniform(-1, 1) * (height / 2.0 - size_px),
                              height / 2.0 + rng.uniform(-1, 1) * (height / 2.0 - size_px));
  Camera camera;
  camera.projection = projection;
  camera.width = width;
  camera.height = height;
  const bool perspective = projection == Camera::Projection::perspective;
  const double focal_px = perspective ? width / 2.0 / std::tan(fov / 2) : size_px / radius;
  camera.K << focal_px, 0, width / 2.0, 0, focal_px, height / 2.0, 0, 0, 1;
  const double depth = perspective ? focal_px * radius / size_px : 2 * radius;
  camera.camera_from_world.linear() = rotation.normalized().toRotationMatrix();
  camera.camera_from_world.translation() =
      (camera.K.inverse() * place.homogeneous()).cwiseProduct(Eigen::Vector3d(depth, depth, depth));
  if (!perspective)
    camera.camera_from_world.translation() << (place - Eigen::Vector2d(width, height) / 2) / focal_px, depth;
  camera.camera_from_world.translation() -= camera.camera_from_world.linear() * box.center();
  return camera;
}

struct Row {
  std::vector<double> overlap, rotation, about_ray, direction, seconds, cpu, tried, pass1;
  int right = 0;
};

Row measure(const TriangleMesh& mesh, const Arguments& arguments) {
  Row row;
  rendering::Renderer renderer(mesh);
  const Eigen::Vector3d center = bounding_box(mesh.vertices).center();
  for (int i = 0; i < arguments.poses; ++i) {
    const Camera truth = random_view(mesh, static_cast<std::uint64_t>(i), arguments.options.projection);
    const Image8 stencil = renderer.stencil(truth);
    const double before = cpu_seconds();
    const alignment::Alignment found =
        alignment::align_photo(mesh, {stencil, std::nullopt}, arguments.options, 1, {});
    row.cpu.push_back(cpu_seconds() - before);
    const metrics::CameraError error = metrics::camera_error(found.camera, truth, center);
    row.overlap.push_back(found.overlap_percent);
    row.rotation.push_back(error.rotation_deg);
    row.about_ray.push_back(error.rotation_about_ray_deg);
    row.seconds.push_back(found.metrics.total_seconds);
    row.pass1.push_back(found.metrics.pass1_seconds);
    row.tried.push_back(found.metrics.candidates_tried);
    row.right += error.rotation_about_ray_deg < 2 ? 1 : 0;
  }
  return row;
}

int run(int count, char** texts) {
  const Arguments arguments = parse(count, texts);
  fmt::print(
      "{:14} {:>7} | {:>7} {:>7} | {:>7} {:>7} {:>7} | {:>7} {:>7} | {:>5} | {:>7} {:>7} {:>7} {:>7}\n",
      "model", "faces", "overlap", "worst", "rot med", "p95", "worst", "ray med", "worst", "< 2", "pass 1",
      "s med", "s worst", "CPU s");
  for (const std::string& model : arguments.models) {
    if (!test::have_data("meshes/" + model)) {
      fmt::print("{:14} skipped: needs meshes/{} of DRAPE_TEST_DATA\n", model, model);
      continue;
    }
    const TriangleMesh mesh = io::read_mesh(test::data("meshes/" + model));
    const Row row = measure(mesh, arguments);
    const metrics::Distribution overlap = metrics::distribution(row.overlap);
    const metrics::Distribution rotation = metrics::distribution(row.rotation);
    const metrics::Distribution about_ray = metrics::distribution(row.about_ray);
    const metrics::Distribution seconds = metrics::distribution(row.seconds);
    fmt::print(
        "{:14} {:7} | {:7.2f} {:7.2f} | {:7.2f} {:7.2f} {:7.2f} | {:7.2f} {:7.2f} | {:2}/{:2} | {:7.2f} "
        "{:7.2f} "
        "{:7.2f} {:7.2f}\n",
        model, mesh.faces.size(), overlap.median, *std::min_element(row.overlap.begin(), row.overlap.end()),
        rotation.median, rotation.percentile_95, rotation.max, about_ray.median, about_ray.max, row.right,
        arguments.poses, metrics::distribution(row.pass1).median, seconds.median, seconds.max,
        metrics::distribution(row.cpu).median);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace drape

int main(int count, char** texts) {
  try {
    return drape::run(count, texts);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
