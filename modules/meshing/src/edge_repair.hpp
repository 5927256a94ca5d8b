// Edges that more than two faces share, or two of opposite orientation.
#pragma once

#include "cleaning.hpp"

namespace drape::meshing {

/// Consistently oriented, with at most two faces on each edge: faces are turned round, and vertices are
/// duplicated (appended) where sheets have to part (CGAL's orient_polygon_soup). The mesh as it is where
/// nothing is wrong. `removed` counts the wrong edges that there were.
[[nodiscard]] Cleaned with_manifold_edges(const TriangleMesh& mesh);

}  // namespace drape::meshing
