// The things of the virtual world: solid, painted objects that code describes.
#pragma once

#include <Eigen/Core>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::simulation {

enum class ObjectKind {
  teapot,  // with a spout, a handle and a lid; about 0.19 m long. It stands on z = 0, the spout towards +x
  statue,  // a figure on a base, about 0.33 m high, looking towards -y; its back is open, and it is hollow
  mug,     // the following stand behind the object in photos with clutter
  apple,
  books
};

/// An object in its own frame: metres, z up, standing on z = 0 about the origin.
struct ObjectSpec {
  ObjectKind kind = ObjectKind::teapot;
  double scale = 1;   // multiplies all lengths, those of the painted pattern too
  double detail = 1;  // above 1: a coarser mesh, with edges and deviations that many times larger
};

/// The object's outer surface as one closed manifold with outward faces, with normals and colours per vertex.
/// The object is an implicit surface (a blend of spline-shaped parts), polygonised by marching tetrahedra on
/// a lattice of about a millimetre and simplified: vertices lie on the surface, faces within about 0.1 mm of
/// it (at detail 1), and flat places have larger faces.
[[nodiscard]] TriangleMesh make_object(const ObjectSpec& spec);

/// Paint of the surface point nearest to `point`: red, green, blue, sRGB-encoded, 0..1. It is a function of
/// position, sharp at any resolution.
[[nodiscard]] Eigen::Vector3f object_color(const ObjectSpec& spec, const Eigen::Vector3d& point);

}  // namespace drape::simulation
