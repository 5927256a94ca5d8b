// Triangles over places in a plane.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

/// A place in the plane and the index that its triangles name it by.
struct PlanarSite {
  double x;
  double y;
  std::uint32_t index;
};

/// Delaunay triangulation, counter-clockwise (CGAL). Of sites at the same place one is used.
[[nodiscard]] std::vector<Face> delaunay_faces(const std::vector<PlanarSite>& sites);

}  // namespace drape::meshing
