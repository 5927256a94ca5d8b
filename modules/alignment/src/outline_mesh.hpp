// A mesh as outlines are drawn of it: in its bounding sphere, with its edges.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::alignment {

/// Where the unit sphere that a mesh is brought into lies in the mesh's own frame: x_mesh = center + radius *
/// x_unit.
struct UnitSphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 1;
};

/// About the middle of the bounding box. Error{input} for a mesh without extent.
[[nodiscard]] UnitSphere unit_sphere(const TriangleMesh& mesh);

struct OutlineEdge {
  static constexpr std::uint32_t no_face = 0xffffffffU;
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  std::uint32_t face = 0;         // runs along the edge from `from` to `to`
  std::uint32_t other = no_face;  // no_face at a border, and where more than two faces meet
  bool border = false;            // it has one face
  bool turned = false;            // the other face runs along it the same way: one of the two is inside out
};

/// Vertices at one place are one vertex here, whatever the file says, so that edges join the faces they part.
struct OutlineMesh {
  std::vector<Eigen::Vector3d> vertices;  // in the unit sphere
  std::vector<Face> faces;
  std::vector<OutlineEdge> edges;
  /// A fan over each border, from its middle: about where the surface is that the scanner did not see.
  /// Corners beyond `vertices` are of `border_middles`.
  std::vector<Face> caps;
  std::vector<Eigen::Vector3d> border_middles;
  bool open = false;  // an edge has one face
  /// Every edge has two faces that run along it in opposite ways: what faces the camera covers all that the
  /// mesh does.
  bool closed = false;
};

[[nodiscard]] OutlineMesh outline_mesh(const TriangleMesh& mesh, const UnitSphere& sphere);

}  // namespace drape::alignment
