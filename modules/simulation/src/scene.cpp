#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drape/base/parallel.hpp"
#include "drape/geometry/bounding_box.hpp"

namespace drape::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using std::numbers::pi;

const Vector3f sky_color(0.62F, 0.68F, 0.76F);     // radiance times pi
const Vector3f bounce_color(0.26F, 0.20F, 0.15F);  // from the table and the room below the horizon
const Vector3f plain_albedo(0.42F, 0.42F, 0.42F);

constexpr int sky_directions = 48;
constexpr int table_cells = 160;
constexpr double table_reach = 3.2;  // half the side of the table's lattice of light, in subject sizes
constexpr double wall_distance = 3.4;
// A thing shadows its neighbourhood only: beyond this the room is bright anyway.
constexpr double shade_reach = 2.5;

/// Evenly spread unit vectors (spherical Fibonacci lattice, Keinert et al. 2015).
Vector3d sphere_direction(int i) {
  const double z = 1 - (2 * i + 1.0) / sky_directions;
  const double around = 2 * pi * i * (std::numbers::phi - 1);
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(around), r * std::sin(around), z};
}

/// Made once: every photo has the same things in it.
const Subject& clutter(ObjectKind kind) {
  static const Subject mug = make_subject({ObjectKind::mug, 1, 1});
  static const Subject apple = make_subject({ObjectKind::apple, 1, 1});
  static const Subject books = make_subject({ObjectKind::books, 1, 1});
  return kind == ObjectKind::mug ? mug : kind == ObjectKind::apple ? apple : books;
}

float srgb_decode(float v) {
  return v <= 0.04045F ? v / 12.92F : std::pow((v + 0.055F) / 1.055F, 2.4F);
}
float srgb_encode(float v) {
  return v <= 0.0031308F ? v * 12.92F : 1.055F * std::pow(v, 1 / 2.4F) - 0.055F;
}

}  // namespace

Vector3f linear_from_srgb(const Vector3f& color) {
  return color.unaryExpr(&srgb_decode);
}
Vector3f srgb_from_linear(const Vector3f& color) {
  return color.unaryExpr(&srgb_encode);
}

Scene::Scene(const Subject& subject, const Camera& camera, const PhotoStyle& style) : style_(style) {
  const BoundingBox box = bounding_box(subject.mesh.vertices);
  size_ = box.diagonal().norm() / 2;
  center_ = {box.center().x(), box.center().y(), box.min().z()};
  Vector3d away = camera.camera_from_world.linear().transpose() * Vector3d::UnitZ();
  away.z() = 0;
  // A camera that looks straight down has no way away from it; its picture's top is as good.
  if (away.norm() < 1e-6) away = -(camera.camera_from_world.linear().transpose() * Vector3d::UnitY());
  away.z() = 0;
  away.normalize();
  world_from_set_.col(0) = away.cross(Vector3d::UnitZ());
  world_from_set_.col(1) = away;
  world_from_set_.col(2) = Vector3d::UnitZ();
  wall_ = wall_distance * size_;

  place(subject, Eigen::Affine3d::Identity());
  if (style.clutter) place_clutter();
  caster_.emplace(mesh_);
  light_vertices();
  light_table();
}

void Scene::place(Subject what, const Eigen::Affine3d& world_from_own) {
  things_.push_back({{}, world_from_own.inverse(), static_cast<std::uint32_t>(mesh_.faces.size())});
  const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
  if (what.mesh.normals.empty()) what.mesh.normals = vertex_normals(what.mesh);
  // Own frames may differ from the world by rotation, translation and scale only.
  const Eigen::Matrix3f turn = world_from_own.linear().cast<float>();
  for (std::size_t i = 0; i < what.mesh.vertices.size(); ++i) {
    mesh_.vertices.push_back(world_from_own * what.mesh.vertices[i]);
    mesh_.normals.push_back((turn * what.mesh.normals[i]).normalized());
    mesh_.colors.push_back(what.mesh.colors.empty() ? Vector3f::Constant(0.7F) : what.mesh.colors[i]);
  }
  for (const Face& face : what.mesh.faces)
    mesh_.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
  what.mesh = {};
  things_.back().what = std::move(what);
}

void Scene::place_clutter() {
  struct Placement {
    ObjectKind kind;
    Vector2d at;  // in the set, in subject sizes
    double turn_deg;
    double scale;
  };
  const std::array<Placement, 4> placements = {{{ObjectKind::books, {2.0, 1.45}, 30, 1.0},
                                                {ObjectKind::mug, {-1.55, 1.5}, -150, 1.0},
                                                {ObjectKind::apple, {-1.75, 0.62}, 40, 1.0},
                                                {ObjectKind::apple, {2.9, 2.3}, 200, 0.9}}};
  for (const Placement& placement : placements) {
    Eigen::Affine3d world_from_own = Eigen::Affine3d::Identity();
    world_from_own.translate(center_ + size_ * (world_from_set_.leftCols<2>() * placement.at));
    world_from_own.rotate(world_from_set_);
    world_from_own.rotate(Eigen::AngleAxisd(placement.turn_deg * pi / 180, Vector3d::UnitZ()));
    world_from_own.scale(placement.scale * size_ / 0.15);
    place(clutter(placement.kind), world_from_own);
  }
}

Vector3f Scene::sky_light(const Vector3d& position, const Vector3d& normal) const {
  Vector3f light = Vector3f::Zero();
  double all = 0;
  for (int i = 0; i < sky_directions; ++i) {
    const Vector3d direction = sphere_direction(i);
    const double cosine = direction.dot(normal);
    if (cosine <= 0) continue;
    all += cosine;
    if (caster_->blocked(position + 1e-3 * size_ * normal, direction, shade_reach * size_)) continue;
    light += static_cast<float>(cosine) * (direction.z() > 0 ? sky_color : bounce_color);
  }
  return all > 0 ? Vector3f(light / static_cast<float>(all)) : Vector3f::Zero();
}

void Scene::light_vertices() {
  vertex_light_.resize(mesh_.vertices.size());
  parallel_for(mesh_.vertices.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      vertex_light_[i] = sky_light(mesh_.vertices[i], mesh_.normals[i].cast<double>());
  });
}

void Scene::light_table() {
  table_light_.resize(static_cast<std::size_t>(table_cells) * table_cells);
  parallel_for(table_light_.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vector2d cell(static_cast<double>(i % table_cells), static_cast<double>(i / table_cells));
      const Vector2d at = (2 * cell / (table_cells - 1) - Vector2d::Ones()) * table_reach * size_;
      table_light_[i] = sky_light(center_ + world_from_set_.leftCols<2>() * at, Vector3d::UnitZ());
    }
  });
}

SurfacePoint Scene::on_table(const Vector3d& position) const {
  SurfacePoint point;
  point.position = position;
  point.normal = Vector3d::UnitZ();
  const Vector2d at = (world_from_set_.transpose() * (position - center_)).head<2>();
  point.albedo =
      style_.clutter ? linear_from_srgb(table_paint(style_.table, at * 0.13 / size_)) : plain_albedo;
  const Vector2d cell = ((at / (table_reach * size_) + Vector2d::Ones()) / 2 * (table_cells - 1))
                            .cwiseMax(0.0)
                            .cwiseMin(table_cells - 1.001);
  const Eigen::Vector2i base = cell.cast<int>();
  const Eigen::Vector2f t = (cell - base.cast<double>()).cast<float>();
  const auto light = [&](int dx, int dy) {
    return table_light_[static_cast<std::size_t>((base.y() + dy) * table_cells + base.x() + dx)];
  };
  point.sky_light = (1 - t.y()) * ((1 - t.x()) * light(0, 0) + t.x() * light(1, 0)) +
                    t.y() * ((1 - t.x()) * light(0, 1) + t.x() * light(1, 1));
  point.gloss = 0.0;
  return point;
}

SurfacePoint Scene::on_wall(const Vector3d& position) const {
  SurfacePoint point;
  point.position = position;
  point.normal = -world_from_set_.col(1);
  const Vector3d at = world_from_set_.transpose() * (position - center_);
  point.albedo = style_.clutter
                     ? linear_from_srgb(wall_paint(style_.table, Vector2d(at.x(), at.z()) * 0.13 / size_))
                     : plain_albedo;
  // Darker towards the corner with the table.
  const double corner = 1 - 0.35 * std::exp(-at.z() / (0.5 * size_));
  point.sky_light = static_cast<float>(corner) * 0.5F * (sky_color + bounce_color);
  return point;
}

SurfacePoint Scene::on_thing(const RayHit& hit, const Vector3d& direction) const {
  const auto after = std::find_if(things_.begin(), things_.end(),
                                  [&](const Thing& thing) { return thing.first_face > hit.face; });
  const Thing& thing = *(after - 1);
  const Face& face = mesh_.faces[hit.face];
  SurfacePoint point;
  point.position.setZero();
  point.normal.setZero();
  point.sky_light.setZero();
  Vector3f color = Vector3f::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const double weight = hit.weights[static_cast<Eigen::Index>(k)];
    point.position += weight * mesh_.vertices[face[k]];
    point.normal += weight * mesh_.normals[face[k]].cast<double>();
    point.sky_light += static_cast<float>(weight) * vertex_light_[face[k]];
    color += static_cast<float>(weight) * mesh_.colors[face[k]];
  }
  const Vector3d own = thing.own_from_world * point.position;
  if (thing.what.normal) point.normal = thing.own_from_world.linear().transpose() * thing.what.normal(own);
  point.normal.normalize();
  if (point.normal.dot(direction) > 0 && scaled_face_normal(mesh_, hit.face).dot(direction) > 0)
    point.normal = -point.normal;  // an open mesh, from its inner side
  point.albedo = linear_from_srgb(thing.what.color ? thing.what.color(own) : color);
  point.gloss = thing.what.gloss;
  point.subject = thing.first_face == 0;
  return point;
}

std::optional<SurfacePoint> Scene::look(const Vector3d& origin, const Vector3d& direction) const {
  const double infinity = std::numeric_limits<double>::infinity();
  const Vector3d away = world_from_set_.col(1);
  const double table = direction.z() < 0 ? (center_.z() - origin.z()) / direction.z() : infinity;
  const double wall =
      direction.dot(away) > 0 ? (wall_ - (origin - center_).dot(away)) / direction.dot(away) : infinity;
  const double nearest = std::min(table > 0 ? table : infinity, wall > 0 ? wall : infinity);
  if (const auto hit = caster_->first_hit(origin, direction, nearest)) return on_thing(*hit, direction);
  if (!std::isfinite(nearest)) return std::nullopt;
  const Vector3d position = origin + nearest * direction;
  return nearest == table ? on_table(position) : on_wall(position);
}

bool Scene::sees_subject(const Vector3d& origin, const Vector3d& direction) const {
  const auto hit = caster_->first_hit(origin, direction);
  return hit && (things_.size() == 1 || hit->face < things_[1].first_face);
}

bool Scene::lit_from(const SurfacePoint& point, const Vector3d& direction) const {
  if (point.normal.dot(direction) <= 0) return false;
  return !caster_->blocked(point.position + 2e-3 * size_ * point.normal, direction);
}

}  // namespace drape::simulation
