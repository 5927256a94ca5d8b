// Objects as implicit surfaces, in millimetres: what the files of the objects make.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "drape/geometry/bounding_box.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::simulation {

/// Negative inside; near the surface about the distance to it.
using Distance = std::function<double(const Eigen::Vector3d&)>;
/// sRGB-encoded, 0..1.
using Paint = std::function<Eigen::Vector3f(const Eigen::Vector3d&)>;

struct ImplicitShape {
  Distance distance;
  Paint color;
  BoundingBox box;          // holds the whole shape
  double pitch = 1.2;       // of the lattice that it is meshed on: under its finest features
  double deviation = 0.04;  // how far faces of the mesh may be from the lattice's surface
};

/// A solid that is joined to the parts before it with a fillet of about this width, or taken away from them
/// with a rounded edge.
struct Part {
  Distance distance;
  double fillet;
  Paint paint;
};

/// All solids less all cuts, within `box`. Each surface point has the paint of the part (or cut) that it
/// belongs to.
[[nodiscard]] ImplicitShape compose(std::vector<Part> solids, std::vector<Part> cuts, const BoundingBox& box);

[[nodiscard]] ImplicitShape teapot_shape();
[[nodiscard]] ImplicitShape statue_shape();
[[nodiscard]] ImplicitShape head_shape();
[[nodiscard]] ImplicitShape machine_part_shape();
[[nodiscard]] ImplicitShape aircraft_shape();
[[nodiscard]] ImplicitShape vase_shape();
[[nodiscard]] ImplicitShape chair_shape();
[[nodiscard]] ImplicitShape mug_shape();
[[nodiscard]] ImplicitShape apple_shape();
[[nodiscard]] ImplicitShape books_shape();

/// Closed, outward faces; no attributes. Error{bug} if the mesher leaves anything else.
[[nodiscard]] TriangleMesh mesh_of(const ImplicitShape& shape, double detail);

/// Unit gradient of the distance by differences over a few tenths of a millimetre.
[[nodiscard]] Eigen::Vector3d outward_normal(const ImplicitShape& shape, const Eigen::Vector3d& point);

}  // namespace drape::simulation
