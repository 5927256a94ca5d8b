// A scan's own lattice as a mesh.
#pragma once

#include "drape/geometry/range_scan.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

/// Delaunay triangulation of the samples' (column, row) places in the scan's grid (CGAL), without triangles
/// that have an edge longer than `longest_edge` or are seen at more than `max_incidence_deg`, in the scan's
/// frame, oriented towards the scanner (by the view, else by the normals, else as the lattice runs). Vertices
/// are the scan's samples with their attributes. The scan must have a grid.
[[nodiscard]] TriangleMesh grid_mesh(const RangeScan& scan, double longest_edge, double max_incidence_deg);

}  // namespace drape::meshing
