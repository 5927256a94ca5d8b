// The things of the virtual world: solid, painted objects that code describes.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::simulation {

enum class ObjectKind {
  teapot,  // with a spout, a handle and a lid; about 0.19 m long. It stands on z = 0, the spout towards +x
  statue,  // a figure on a base, about 0.33 m high, looking towards -y; its back is open, and it is hollow
  head,    // a bust on a plinth, about 0.27 m high, looking towards -y
  machine_part,  // a cast bracket with through holes, 0.165 m long
  aircraft,      // with thin wings; 0.23 m across, its nose towards -y
  vase,          // a body of rotation about z, 0.22 m high; its paint is not
  chair,         // mirror-symmetric in its shape; 0.2 m high
  mug,           // the following stand behind the object in photos with clutter
  apple,
  books
};

/// As options and files name it: "machine_part".
[[nodiscard]] std::string object_name(ObjectKind kind);

/// An object in its own frame: metres, z up, standing on z = 0 about the origin.
struct ObjectSpec {
  ObjectKind kind = ObjectKind::teapot;
  double scale = 1;   // multiplies all lengths, those of the painted pattern too
  double detail = 1;  // above 1: a coarser mesh, with edges and deviations that many times larger
};

/// Motions that map an object's shape onto itself (its paint may differ), but for what meshing leaves.
struct ObjectSymmetry {
  bool about_z = false;                   // any turn about the z axis
  std::optional<Eigen::Vector3d> mirror;  // normal of a mirror plane through the origin
};
[[nodiscard]] ObjectSymmetry object_symmetry(ObjectKind kind);

/// The object's outer surface as one closed manifold with outward faces, with normals and colours per vertex.
/// The object is an implicit surface (a blend of spline-shaped parts), polygonised by marching tetrahedra on
/// a lattice of about a millimetre and simplified: vertices lie on the surface, faces within about 0.1 mm of
/// it (at detail 1), and flat places have larger faces.
[[nodiscard]] TriangleMesh make_object(const ObjectSpec& spec);

/// Paint of the surface point nearest to `point`: red, green, blue, sRGB-encoded, 0..1. It is a function of
/// position, sharp at any resolution.
[[nodiscard]] Eigen::Vector3f object_color(const ObjectSpec& spec, const Eigen::Vector3d& point);

}  // namespace drape::simulation
