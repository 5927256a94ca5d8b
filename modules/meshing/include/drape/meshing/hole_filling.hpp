// Closing the holes that scanning left.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "drape/base/options.hpp"
#include "drape/base/progress.hpp"
#include "drape/geometry/range_scan.hpp"
#include "drape/geometry/rigid3.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

enum class Base { automatic, flat, leave };

/// Lengths are in point spacings.
struct FillOptions {
  double max_hole_size_spacings = 600;
  Base base = Base::automatic;
  bool keep_outer_border = true;
  bool keep_seen_space_open = true;
  bool repair = true;
  double min_component_percent = 0;
  int smooth_rounds = 0;
  int simplify_triangles = 60000;
  double simplify_error_spacings = 0;
};

inline void describe(Binder& b, FillOptions& o) {
  b.number("max_hole_size_spacings", o.max_hole_size_spacings, {0, 1e6},
           "fill holes whose boundary is shorter than this; larger ones stay open (0: all stay open)");
  b.choice(
      "base", o.base, {{"auto", Base::automatic}, {"flat", Base::flat}, {"leave", Base::leave}},
      "auto: where the object was cut or stood (a flat border with the whole piece on one side, that the "
      "surface meets steeply) a plane closes it, whatever its length; flat: the longest border is closed by "
      "a plane, whatever its shape; leave: such a base stays open");
  b.flag("keep_outer_border", o.keep_outer_border,
         "leave the rim of an open sheet (a hole that spans a quarter of its piece's area or more) open, "
         "whatever its length");
  b.flag("keep_seen_space_open", o.keep_seen_space_open,
         "leave a hole open if every patch for it would stand in space that a scanner looked through");
  b.flag("repair", o.repair,
         "first drop degenerate and repeated faces, join borders with the same coordinates, part faces that "
         "more than two share an edge, and take up faces without area into those beside them");
  b.number("min_component_percent", o.min_component_percent, {0, 100},
           "pieces with a smaller share of all faces are removed");
  b.number("smooth_rounds", o.smooth_rounds, {0, 50},
           "smooth the surface before filling, keeping its edges and creases, so many times (0: not one "
           "vertex moves)");
  b.number(
      "simplify_triangles", o.simplify_triangles, {0, 100000000},
      "triangles of the simplified mesh, which texturing uses: texture pictures hold the detail, so more "
      "make the model larger, not finer; 0: as few as simplify_error_spacings allows (both 0: no "
      "simplification)");
  b.number("simplify_error_spacings", o.simplify_error_spacings, {0, 1e4},
           "simplify no further than where the surface would move by more than this; 0: no such bound");
}

enum class HoleAction {
  fair,   // a curved patch that continues the surface round it
  plain,  // triangles between the boundary's vertices (or new ones on them), where a curved patch would not
          // do
  flat,   // a planar cap: a base
  leave
};
[[nodiscard]] std::string to_string(HoleAction action);

/// A boundary loop of the mesh, and what became of it. Lengths in the mesh's unit.
struct Hole {
  std::size_t boundary_edges = 0;
  double length = 0;                                 // of the boundary
  double area = 0;                                   // that it spans: of its projection along its mean normal
  double flatness = 0;                               // RMS distance of the boundary from its mean plane
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  // mean of the boundary's vertices
  HoleAction action = HoleAction::leave;
  std::string
      why;  // "shorter than max_hole_size_spacings; refined and faired", "outer border of an open sheet"
  std::size_t faces_added = 0;

  [[nodiscard]] bool filled() const { return action != HoleAction::leave; }
};

/// Scans with their view, and where they stand. Of equal length; both may be empty.
struct PlacedScans {
  std::span<const RangeScan> scans;
  std::span<const Rigid3> world_from_scan;
};

struct FillResult {
  TriangleMesh mesh;        // the full mesh; `filled` marks the faces that were added
  TriangleMesh simplified;  // the same surface with fewer faces
  std::vector<Hole> holes;  // in the order of their least vertex
  std::size_t components_removed = 0;
  std::size_t bad_faces_removed = 0;      // degenerate, repeated or without area
  std::size_t vertices_joined = 0;        // border vertices with the same coordinates
  std::size_t non_manifold_repaired = 0;  // edges and vertices
  std::size_t self_intersections = 0;     // pairs of faces of which one is an added one
};

/// Fills holes. What was there stays: faces that are kept come first, in their order, vertices too, with the
/// same bits (unless smooth_rounds moves them), and at the same index unless repair or min_component_percent
/// removed some; new vertices and faces follow. A hole's patch is triangulated (Liepa 2003: least dihedral
/// angle, then area), refined to the density round it and faired (Botsch and Kobbelt 2004), all by CGAL; ear
/// clipping or a fan stand in where that finds none. The patches of long loops are coarser, so that the cost
/// stays bounded. A patch that would cut the surface is triangulated anew where it does, and where that does
/// not help replaced by one that does so less, in the end by the triangulation of the hole that does so least
/// (a border that runs through the surface leaves none that does not; that triangulation is sought for up to
/// 64 edges, and a longer loop whose patches all cut the surface in many places stays open), and one that
/// would stand in space that a scan saw through by one that does not: where there is none, the hole stays
/// open. Several borders that touch in one vertex are filled as separate simple loops; an island inside a
/// hole, and the inner rim of a hollow base, are joined to the loop round them.
///
/// `spacing` > 0, in the mesh's unit. Error{input} if the mesh breaks its promises (problem_of).
[[nodiscard]] FillResult fill_holes(const TriangleMesh& mesh, double spacing, const FillOptions& options,
                                    const PlacedScans& seen_by = {}, const Progress& progress = {});

}  // namespace drape::meshing
