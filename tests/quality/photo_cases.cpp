#include "photo_cases.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "drape/base/files.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/metrics/camera_error.hpp"
#include "drape/rendering/renderer.hpp"
#include "drape/simulation/objects.hpp"
#include "drape/simulation/virtual_camera.hpp"
#include "real_photos.hpp"
#include "support.hpp"
#include "visual_hull.hpp"

namespace drape {
namespace {

using simulation::ObjectKind;

constexpr ObjectKind kinds[] = {ObjectKind::teapot,       ObjectKind::statue,   ObjectKind::head,
                                ObjectKind::machine_part, ObjectKind::aircraft, ObjectKind::chair,
                                ObjectKind::vase};

Camera camera_of(const nlohmann::json& item, int width, int height) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      camera.K(r, c) = item["K"][static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
      camera.camera_from_world.linear()(r, c) =
          item["R"][static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
    }
    camera.camera_from_world.translation()[r] = item["t"][static_cast<std::size_t>(r)];
  }
  camera.K(0, 2) += 0.5;  // pixel centres lie at integers in that file
  camera.K(1, 2) += 0.5;
  return camera;
}

// A square block under the object, half as high as it, and narrower.
void add_plinth(TriangleMesh& mesh) {
  const BoundingBox box = bounding_box(mesh.vertices);
  const double width = 0.35 * box.diagonal().head<2>().minCoeff();
  const double height = 0.4 * box.diagonal().z();
  const Eigen::Vector3d middle = box.center();
  const TriangleMesh block =
      test::box({middle.x() - width, middle.y() - width, box.min().z() - height},
                {middle.x() + width, middle.y() + width, box.min().z() + 0.01 * height});
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), block.vertices.begin(), block.vertices.end());
  for (const Face& face : block.faces)
    mesh.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
}

simulation::Subject on_plinth(const simulation::ObjectSpec& spec, double gloss) {
  simulation::Subject subject = simulation::make_subject(spec);
  const double floor = bounding_box(subject.mesh.vertices).min().z();
  TriangleMesh joined;
  joined.vertices = subject.mesh.vertices;
  joined.faces = subject.mesh.faces;
  add_plinth(joined);
  subject.mesh = joined;
  const auto paint = subject.color;
  const auto normal = subject.normal;
  subject.gloss = gloss;
  subject.color = [paint, floor](const Eigen::Vector3d& x) {
    return x.z() < floor - 1e-6 ? Eigen::Vector3f(0.32F, 0.32F, 0.33F) : paint(x);
  };
  const double half =
      0.5 * (bounding_box(joined.vertices).max().x() + bounding_box(joined.vertices).min().x());
  const double middle_y =
      0.5 * (bounding_box(joined.vertices).max().y() + bounding_box(joined.vertices).min().y());
  subject.normal = [normal, floor, half, middle_y](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    if (x.z() >= floor - 1e-6) return normal(x);
    const double dx = x.x() - half;
    const double dy = x.y() - middle_y;
    if (std::abs(dx) > std::abs(dy)) return Eigen::Vector3d(dx > 0 ? 1 : -1, 0, 0);
    return Eigen::Vector3d(0, dy > 0 ? 1 : -1, 0);
  };
  return subject;
}

}  // namespace

std::vector<PhotoCase> lmo_cases() {
  std::vector<PhotoCase> cases;
  if (!test::have_data("photos/lmo") || !test::have_data("photos/poses.json")) return cases;
  const nlohmann::json poses = nlohmann::json::parse(read_file(test::data("photos/poses.json")));
  for (const auto& item : poses["items"]) {
    const std::string name = item["id"];
    if (name.find("lmo_") != 0) continue;
    PhotoCase photo;
    photo.name = name;
    photo.mesh = io::read_mesh(test::data(item["mesh"].get<std::string>()));
    photo.rgb = io::read_photo(test::data(item["image"].get<std::string>())).rgb;
    photo.truth = camera_of(item, photo.rgb.width(), photo.rgb.height());
    photo.silhouette = rendering::Renderer(photo.mesh).stencil(photo.truth);
    cases.push_back(std::move(photo));
  }
  return cases;
}

std::vector<PhotoCase> dino_cases() {
  std::vector<PhotoCase> cases;
  std::vector<lab::Outline> outlines;
  const std::vector<lab::PosedPhoto> photos = lab::posed_photos("dino");
  for (std::size_t i = 0; i < photos.size(); ++i) {
    Image8 rgb = io::read_photo(photos[i].image).rgb;
    if (i % 2 == 0)
      outlines.push_back({photos[i].truth, lab::dino_stencil(rgb)});
    else
      cases.push_back({photos[i].name, {}, std::move(rgb), photos[i].truth, {}});
  }
  if (cases.empty()) return cases;
  const TriangleMesh hull = lab::dino_hull(outlines);
  for (PhotoCase& photo : cases) {
    photo.mesh = hull;
    photo.silhouette = rendering::Renderer(hull).stencil(photo.truth);
  }
  return cases;
}

PhotoCase simulated_case(int index, Scene scene, const std::filesystem::path& cache) {
  Rng rng(item_seed(scene == Scene::clutter ? 1 : 2, static_cast<std::uint64_t>(index)));
  simulation::ObjectSpec spec;
  spec.kind = kinds[static_cast<std::size_t>(index) % std::size(kinds)];
  PhotoCase photo;
  photo.name = simulation::object_name(spec.kind);
  photo.turns_about_z = simulation::object_symmetry(spec.kind).about_z;
  const simulation::Subject subject =
      scene == Scene::studio ? on_plinth(spec, rng.uniform(0, 0.3)) : simulation::make_subject(spec);
  photo.mesh = simulation::make_object(spec);
  const double fill = rng.uniform(35, 75);
  const double room = (100 - fill) / 200;
  photo.truth = simulation::camera_round(photo.mesh, 480, 360, rng.uniform(25, 50), rng.uniform(0, 360),
                                         rng.uniform(5, 55), rng.uniform(-8, 8), fill,
                                         {rng.uniform(-room, room), rng.uniform(-room, room)});
  simulation::PhotoStyle style;
  style.clutter = scene == Scene::clutter;
  style.table = rng.below(2) == 0 ? simulation::Table::wood : simulation::Table::cloth;
  style.seed = item_seed(3, static_cast<std::uint64_t>(index));
  const std::filesystem::path kept =
      cache.empty() ? cache
                    : cache / fmt::format("{}-{}.png", scene == Scene::clutter ? "clutter" : "studio", index);
  if (!kept.empty() && std::filesystem::exists(kept)) {
    photo.rgb = io::read_photo(kept).rgb;
  } else {
    photo.rgb = simulation::take_photo(subject, photo.truth, style).image;
    if (!kept.empty()) io::write_image(kept, photo.rgb);
  }
  photo.silhouette = rendering::Renderer(photo.mesh).stencil(photo.truth);
  return photo;
}

std::array<double, 4> object_box(const Image8& silhouette) {
  int left = silhouette.width(), top = silhouette.height(), right = 0, bottom = 0;
  for (int y = 0; y < silhouette.height(); ++y)
    for (int x = 0; x < silhouette.width(); ++x) {
      if (silhouette.at(x, y) != stencil::object) continue;
      left = std::min(left, x);
      right = std::max(right, x + 1);
      top = std::min(top, y);
      bottom = std::max(bottom, y + 1);
    }
  return {double(left), double(top), double(right - left), double(bottom - top)};
}

std::array<double, 4> loose_box(const Image8& silhouette, Rng& rng) {
  const auto [x, y, width, height] = object_box(silhouette);
  const double left = rng.uniform(0.03, 0.35) * width;
  const double top = rng.uniform(0.03, 0.35) * height;
  return {x - left, y - top, width + left + rng.uniform(0.03, 0.35) * width,
          height + top + rng.uniform(0.03, 0.35) * height};
}

std::array<double, 2> click_inside(const Image8& silhouette, Rng& rng) {
  std::vector<std::size_t> inside;
  for (std::size_t i = 0; i < silhouette.data().size(); ++i)
    if (silhouette.data()[i] == stencil::object) inside.push_back(i);
  const std::size_t chosen = inside[static_cast<std::size_t>(rng.below(inside.size()))];
  const auto width = static_cast<std::size_t>(silhouette.width());
  return {static_cast<double>(chosen % width) + 0.5, static_cast<double>(chosen / width) + 0.5};
}

PoseError pose_error(const PhotoCase& photo, const Camera& found) {
  PoseError error;
  const Eigen::Vector3d center = bounding_box(photo.mesh.vertices).center();
  error.rotation_deg = metrics::camera_error(found, photo.truth, center).rotation_about_ray_deg;
  if (photo.turns_about_z) {
    // The axis alone is seen: where it points to, as seen along the ray to the object.
    const auto seen = [&](const Camera& camera) {
      const Eigen::Vector3d ray = camera.towards_camera(center);
      const Eigen::Vector3d up = camera.camera_from_world.linear() * Eigen::Vector3d::UnitZ();
      return std::pair{std::acos(std::clamp(ray.z(), -1.0, 1.0)), std::atan2(up.y(), up.x())};
    };
    const auto [height_found, roll_found] = seen(found);
    const auto [height_true, roll_true] = seen(photo.truth);
    error.rotation_deg =
        std::hypot(height_found - height_true,
                   std::remainder(roll_found - roll_true, 2 * std::numbers::pi) * std::sin(height_true)) *
        180 / std::numbers::pi;
  }
  if (photo.turns_about_z) return error;
  std::vector<double> shifts;
  for (std::size_t i = 0; i < photo.mesh.vertices.size(); i += 1 + photo.mesh.vertices.size() / 2000)
    shifts.push_back(
        (found.project(photo.mesh.vertices[i]).pixel - photo.truth.project(photo.mesh.vertices[i]).pixel)
            .norm());
  std::nth_element(shifts.begin(), shifts.begin() + static_cast<std::ptrdiff_t>(shifts.size() / 2),
                   shifts.end());
  const auto box = object_box(photo.silhouette);
  error.size_percent = 100 * shifts[shifts.size() / 2] / std::max(box[2], box[3]);
  return error;
}

}  // namespace drape
