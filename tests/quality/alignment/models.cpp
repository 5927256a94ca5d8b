#include "models.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "drape/base/error.hpp"
#include "drape/base/random.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/io/mesh_files.hpp"
#include "support.hpp"

namespace drape::lab {
namespace {

using simulation::ObjectKind;

constexpr double detail = 1.5;  // of the simulated meshes: 6,000 to 30,000 faces
constexpr ObjectKind simulated[] = {ObjectKind::teapot,       ObjectKind::statue,   ObjectKind::head,
                                    ObjectKind::machine_part, ObjectKind::aircraft, ObjectKind::vase,
                                    ObjectKind::chair};
constexpr const char* holed_scan = "Laurana50k.ply";

Model simulated_model(ObjectKind kind) {
  Model model;
  model.name = simulation::object_name(kind);
  model.object = simulation::make_object({kind, 1, detail});
  model.scanned = model.object;
  model.scanned.colors.clear();  // the outline and the photo's light are what is measured
  model.symmetry = simulation::object_symmetry(kind);
  model.thin_or_holed = kind == ObjectKind::aircraft || kind == ObjectKind::chair;
  return model;
}

Model model_of_file(const std::string& name) {
  Model model;
  model.name = name;
  model.object = io::read_mesh(test::data("meshes/" + name));
  model.object.colors.clear();
  model.scanned = model.object;
  if (name == holed_scan) model.scanned = with_holes(model.object, 6, 0.06, Eigen::Vector3d::UnitZ(), 1);
  model.thin_or_holed = name == holed_scan || name == "cessna.obj";
  return model;
}

}  // namespace

const std::vector<std::string>& model_names() {
  static const std::vector<std::string> names = {
      "teapot", "statue",     "head",       "machine_part",   "aircraft",    "vase",
      "chair",  "teapot.obj", "cessna.obj", "rocker-arm.obj", "fandisk.obj", holed_scan};
  return names;
}

std::optional<Model> load_model(const std::string& name) {
  const auto& names = model_names();
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw config_error("there is no model {}; there are {}", name, fmt::join(names, ", "));
  for (const ObjectKind kind : simulated)
    if (simulation::object_name(kind) == name) return simulated_model(kind);
  if (!test::have_data("meshes/" + name)) {
    fmt::print("{} skipped: needs meshes/{} of DRAPE_TEST_DATA\n", name, name);
    return std::nullopt;
  }
  return model_of_file(name);
}

std::vector<Model> load_models(const std::vector<std::string>& names) {
  std::vector<Model> models;
  for (const std::string& name : names.empty() ? model_names() : names)
    if (std::optional<Model> model = load_model(name)) models.push_back(std::move(*model));
  return models;
}

TriangleMesh with_holes(const TriangleMesh& mesh, int count, double radius, const Eigen::Vector3d& front,
                        std::uint64_t seed) {
  const Ball ball = ball_about(mesh);
  Rng rng(seed);
  std::vector<Eigen::Vector3d> middles;
  for (int i = 0; i < count; ++i) middles.push_back(mesh.vertices[rng.below(mesh.vertices.size())]);
  TriangleMesh holed = mesh;
  holed.faces.clear();
  for (const auto& face : mesh.faces) {
    const Eigen::Vector3d a = mesh.vertices[face[0]];
    const Eigen::Vector3d b = mesh.vertices[face[1]];
    const Eigen::Vector3d c = mesh.vertices[face[2]];
    const Eigen::Vector3d middle = (a + b + c) / 3;
    const bool punched = std::any_of(middles.begin(), middles.end(), [&](const Eigen::Vector3d& x) {
      return (x - middle).norm() < radius * ball.radius;
    });
    const double facing = (b - a).cross(c - a).normalized().dot(front);
    const bool back = facing < -0.6 && (middle - ball.center).norm() < 0.7 * ball.radius;
    if (!punched && !back) holed.faces.push_back(face);
  }
  return holed;
}

Ball ball_about(const TriangleMesh& mesh) {
  const Eigen::Vector3d center = bounding_box(mesh.vertices).center();
  double radius = 0;
  for (const Eigen::Vector3d& x : mesh.vertices) radius = std::max(radius, (x - center).norm());
  return {center, radius};
}

}  // namespace drape::lab
