// Closing the holes that scanning left.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "drape/base/options.hpp"
#include "drape/base/progress.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

/// Lengths are in point spacings.
struct FillOptions {
  double max_hole_size_spacings = 600;
  bool keep_outer_border = true;
  bool repair = true;
  double min_component_percent = 0;
  int simplify_triangles = 60000;
};

inline void describe(Binder& b, FillOptions& o) {
  b.number("max_hole_size_spacings", o.max_hole_size_spacings, {0, 1e6},
           "fill holes whose boundary is shorter than this; larger ones stay open (0: all stay open)");
  b.flag("keep_outer_border", o.keep_outer_border,
         "leave the rim of an open sheet (a hole that spans a quarter of its piece's area or more) open, "
         "whatever its length");
  b.flag("repair", o.repair,
         "first drop degenerate and repeated faces, join borders with the same coordinates, and part faces "
         "that more than two share an edge");
  b.number("min_component_percent", o.min_component_percent, {0, 100},
           "pieces with a smaller share of all faces are removed");
  b.number(
      "simplify_triangles", o.simplify_triangles, {0, 100000000},
      "triangles of the simplified mesh, which texturing uses: texture pictures hold the detail, so more "
      "make the model larger, not finer; 0: no simplification");
}

/// A boundary loop of the mesh, and what became of it.
struct Hole {
  std::size_t boundary_edges = 0;
  double length = 0;                                 // of the boundary, in the mesh's unit
  double area = 0;                                   // that it spans: of its projection along its mean normal
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  // mean of the boundary's vertices
  bool filled = false;
  std::string
      why;  // "shorter than max_hole_size_spacings; refined and faired", "outer border of an open sheet"
  std::size_t faces_added = 0;
};

struct FillResult {
  TriangleMesh mesh;        // the full mesh; `filled` marks the faces that were added
  TriangleMesh simplified;  // the same surface with at most about simplify_triangles faces
  std::vector<Hole> holes;  // in the order of their least vertex
  std::size_t components_removed = 0;
  std::size_t bad_faces_removed = 0;      // degenerate or repeated
  std::size_t vertices_joined = 0;        // border vertices with the same coordinates
  std::size_t non_manifold_repaired = 0;  // edges and vertices
  std::size_t self_intersections = 0;     // pairs of faces of which one is an added one
};

/// Fills holes. What was there stays: faces that are kept come first, in their order, vertices too, with the
/// same bits, and at the same index unless repair or min_component_percent removed some; new vertices and
/// faces follow. A hole's patch is triangulated (Liepa 2003: least dihedral angle, then area), refined to the
/// density round it and faired (Botsch and Kobbelt 2004), all by CGAL; ear clipping or a fan stand in where
/// that finds none. The patches of long loops are coarser, so that the cost stays bounded. A patch that would
/// cut the surface is replaced by one that does so less. Several borders that touch in one vertex are filled
/// as separate simple loops.
///
/// `spacing` > 0, in the mesh's unit. Error{input} if the mesh breaks its promises (problem_of).
[[nodiscard]] FillResult fill_holes(const TriangleMesh& mesh, double spacing, const FillOptions& options,
                                    const Progress& progress = {});

}  // namespace drape::meshing
