// From registered scans to one triangle mesh.
#pragma once

#include <cstddef>
#include <span>

#include "drape/base/options.hpp"
#include "drape/base/progress.hpp"
#include "drape/geometry/point_cloud.hpp"
#include "drape/geometry/range_scan.hpp"
#include "drape/geometry/rigid3.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

enum class Method { automatic, fusion, poisson, advancing_front, scale_space, grid };

/// Lengths are in point spacings (MeshInput::spacing).
struct MeshOptions {
  Method method = Method::automatic;
  double fusion_voxel_spacings = 0.65;
  bool closed = false;
  double merge_voxel_spacings = 2.0;
  double poisson_radius_spacings = 2.0;
  double poisson_distance_spacings = 0.25;
  double trim_spacings = 4.0;
  double grid_max_edge_spacings = 6.0;
  double grid_max_incidence_deg = 85.0;
  double min_component_percent = 0.5;
};

inline void describe(Binder& b, MeshOptions& o) {
  b.choice(
      "method", o.method,
      {{"auto", Method::automatic},
       {"fusion", Method::fusion},
       {"poisson", Method::poisson},
       {"advancing_front", Method::advancing_front},
       {"scale_space", Method::scale_space},
       {"grid", Method::grid}},
      "fusion: what all scans agree on along their lines of sight, open where none saw the surface; needs to "
      "know from where or in which direction the scans looked; poisson: smooths over noise and small gaps; "
      "advancing_front: through the merged samples; scale_space: the same, found on smoothed samples; grid: "
      "each scan's own lattice, exact to its samples, "
      "scans "
      "are not joined (for a single scan); auto: fusion where every scan allows for it, else poisson, or "
      "advancing_front without normals");
  b.flag(
      "closed", o.closed,
      "fusion: a closed mesh round all that no scan saw to be empty, instead of holes; where much is unseen, "
      "much is invented (marked as filled)");
  b.number("fusion_voxel_spacings", o.fusion_voxel_spacings, {0.1, 100},
           "fusion: the voxels' size, which is about the mesh's edges; time and memory grow with its inverse "
           "square");
  b.number(
      "merge_voxel_spacings", o.merge_voxel_spacings, {0, 100},
      "poisson, advancing_front: samples within a voxel of this size become one; 0 keeps all (slow where "
      "scans overlap)");
  b.number("poisson_radius_spacings", o.poisson_radius_spacings, {0.1, 100},
           "poisson: the most that the radius of a triangle's circumcircle may be; the time grows with its "
           "inverse square");
  b.number("poisson_distance_spacings", o.poisson_distance_spacings, {0.01, 100},
           "poisson: the most that a triangle may be off the implicit surface");
  b.number("trim_spacings", o.trim_spacings, {0.5, 1e6},
           "poisson, advancing_front: surface that is farther than this from every sample is cut away");
  b.number("grid_max_edge_spacings", o.grid_max_edge_spacings, {1, 1e6},
           "fusion, grid: triangles of a scan with a longer edge span a depth step and are dropped");
  b.number("grid_max_incidence_deg", o.grid_max_incidence_deg, {0, 90},
           "fusion, grid: triangles seen at a flatter angle (0: head-on) span a depth step and are dropped");
  b.number("min_component_percent", o.min_component_percent, {0, 100},
           "pieces with a smaller share of all faces are removed");
}

/// `world_from_scan` is as long as `scans`. `cloud` holds the registered samples of all scans in the world
/// frame (see needs_cloud). `spacing` is their median distance to the next sample of the same scan, > 0.
struct MeshInput {
  std::span<const RangeScan> scans;
  std::span<const Rigid3> world_from_scan;
  const PointCloud& cloud;
  double spacing = 0;
};

struct MeshResult {
  TriangleMesh mesh;                   // world frame, with normals, and the attributes that the samples have
  Method method = Method::automatic;   // that was used
  std::size_t samples_used = 0;        // after merging
  std::size_t faces_trimmed = 0;       // too far from every sample
  std::size_t components_removed = 0;  // too small
  std::size_t non_manifold_repaired = 0;        // edges and vertices
  std::size_t self_intersections_repaired = 0;  // pairs of faces that crossed
  std::size_t self_intersections = 0;           // pairs that still cross; of several grids where sheets do
  bool normals_reversed = false;                // the cloud's normals pointed away from the scanners
};

/// Whether meshing these scans by a method makes use of MeshInput::cloud, which else may be empty.
[[nodiscard]] bool needs_cloud(std::span<const RangeScan> scans, Method method);

/// Meshes registered scans. Every outcome is a manifold mesh (each edge has one or two faces, each vertex one
/// fan of faces) that is consistently oriented: outward, which is towards the scanners where these are known.
/// Where faces cross they are cut out and the cut is closed; of fusion none do, since a triangle of marching
/// cubes lies within its cube, and the sheets of several grids may cross, since they are not joined.
///
/// fusion: Curless and Levoy 1996 on denoised range grids. About 2 us a sample at the default voxel. Scans
/// without a grid are triangulated as their sight sees them (8 us a sample).
///
/// scale_space: Digne et al. 2011 (CGAL), through the merged samples.
///
/// poisson: Kazhdan, Bolitho and Hoppe 2006, on a Delaunay refinement of the samples, contoured by restricted
/// Delaunay triangulation (CGAL). Needs normals. About 20 us a merged sample plus 100 us a vertex of the
/// mesh. advancing_front: Cohen-Steiner and Da 2004 (CGAL). About 25 us a merged sample. grid: Delaunay
/// triangulation of each scan's lattice (CGAL). About 5 us a sample. Where scans overlap so do their sheets.
///
/// Error{input} where the samples define no surface (too few, all on a line, no normals for poisson, no grids
/// for grid, no view for fusion, every sample far from its neighbours).
[[nodiscard]] MeshResult mesh_scans(const MeshInput& input, const MeshOptions& options,
                                    const Progress& progress = {});

}  // namespace drape::meshing
