// Surface reconstruction by Poisson's equation.
#pragma once

#include "drape/base/progress.hpp"
#include "drape/geometry/point_cloud.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

struct PoissonSizes {
  double spacing;         // typical distance of neighbouring samples
  double facet_radius;    // the most that a triangle's circumcircle may have
  double facet_distance;  // the most that a triangle may be off the implicit surface
};

/// The closed surface between inside and outside by the samples' normals, consistently oriented piece by
/// piece but not yet outward. Kazhdan, Bolitho and Hoppe 2006, solved on a Delaunay refinement of the
/// samples; the contour is meshed by restricted Delaunay refinement (Boissonnat and Oudot 2005), both by
/// CGAL. Where no sample is, the surface is a guess: trim it. An empty mesh where the normals enclose
/// nothing.
[[nodiscard]] TriangleMesh poisson_mesh(const PointCloud& samples, const PoissonSizes& sizes,
                                        const Progress& progress);

}  // namespace drape::meshing
