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
  static const ImplicitShape mug = mug_shape();
  static const ImplicitShape apple = apple_shape();
  static const ImplicitShape books = books_shape();
  switch (kind) {
    case ObjectKind::teapot:
      return teapot;
    case ObjectKind::statue:
      return statue;
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
  if (spec.kind == ObjectKind::apple) subject.gloss = 0.08;
  return subject;
}

}  // namespace drape::simulation
