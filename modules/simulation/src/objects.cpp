#include "drape/simulation/objects.hpp"

#include "drape/base/error.hpp"
#include "drape/base/parallel.hpp"
#include "drape/simulation/virtual_camera.hpp"
#include "implicit_shape.hpp"

namespace drape::simulation {
namespace {

constexpr double metres_per_millimetre = 0.001;

const ImplicitShape& shape_of(ObjectKind kind) {
  static const ImplicitShape teapot = teapot_shape();
  static const ImplicitShape statue = statue_shape();
  static const ImplicitShape head = head_shape();
  static const ImplicitShape machine_part = machine_part_shape();
  static const ImplicitShape aircraft = aircraft_shape();
  static const ImplicitShape vase = vase_shape();
  static const ImplicitShape chair = chair_shape();
  static const ImplicitShape mug = mug_shape();
  static const ImplicitShape apple = apple_shape();
  static const ImplicitShape books = books_shape();
  switch (kind) {
    case ObjectKind::teapot:
      return teapot;
    case ObjectKind::statue:
      return statue;
    case ObjectKind::head:
      return head;
    case ObjectKind::machine_part:
      return machine_part;
    case ObjectKind::aircraft:
      return aircraft;
    case ObjectKind::vase:
      return vase;
    case ObjectKind::chair:
      return chair;
    case ObjectKind::mug:
      return mug;
    case ObjectKind::apple:
      return apple;
    case ObjectKind::books:
      return books;
  }
  throw Error(ErrorCode::bug, "an object of no kind");
}

}  // namespace

TriangleMesh make_object(const ObjectSpec& spec) {
  const ImplicitShape& shape = shape_of(spec.kind);
  TriangleMesh mesh = mesh_of(shape, spec.detail);
  mesh.normals.resize(mesh.vertices.size());
  mesh.colors.resize(mesh.vertices.size());
  parallel_for(mesh.vertices.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      mesh.normals[i] = outward_normal(shape, mesh.vertices[i]).cast<float>();
      mesh.colors[i] = shape.color(mesh.vertices[i]);
      mesh.vertices[i] *= metres_per_millimetre * spec.scale;
    }
  });
  return mesh;
}

Eigen::Vector3f object_color(const ObjectSpec& spec, const Eigen::Vector3d& point) {
  return shape_of(spec.kind).color(point / (metres_per_millimetre * spec.scale));
}

std::string object_name(ObjectKind kind) {
  switch (kind) {
    case ObjectKind::teapot:
      return "teapot";
    case ObjectKind::statue:
      return "statue";
    case ObjectKind::head:
      return "head";
    case ObjectKind::machine_part:
      return "machine_part";
    case ObjectKind::aircraft:
      return "aircraft";
    case ObjectKind::vase:
      return "vase";
    case ObjectKind::chair:
      return "chair";
    case ObjectKind::mug:
      return "mug";
    case ObjectKind::apple:
      return "apple";
    case ObjectKind::books:
      return "books";
  }
  throw Error(ErrorCode::bug, "an object of no kind");
}

ObjectSymmetry object_symmetry(ObjectKind kind) {
  ObjectSymmetry symmetry;
  symmetry.about_z = kind == ObjectKind::vase;
  if (kind == ObjectKind::chair) symmetry.mirror = Eigen::Vector3d::UnitX();
  if (kind == ObjectKind::teapot || kind == ObjectKind::mug) symmetry.mirror = Eigen::Vector3d::UnitY();
  return symmetry;
}

Subject make_subject(const ObjectSpec& spec) {
  const ImplicitShape& shape = shape_of(spec.kind);
  const double millimetres = 1 / (metres_per_millimetre * spec.scale);
  Subject subject;
  subject.mesh = make_object(spec);
  subject.color = [&shape, millimetres](const Eigen::Vector3d& p) { return shape.color(millimetres * p); };
  subject.normal = [&shape, millimetres](const Eigen::Vector3d& p) {
    return outward_normal(shape, millimetres * p);
  };
  if (spec.kind == ObjectKind::teapot) subject.gloss = 0.12;
  if (spec.kind == ObjectKind::apple || spec.kind == ObjectKind::aircraft) subject.gloss = 0.08;
  if (spec.kind == ObjectKind::machine_part || spec.kind == ObjectKind::vase) subject.gloss = 0.05;
  return subject;
}

}  // namespace drape::simulation
