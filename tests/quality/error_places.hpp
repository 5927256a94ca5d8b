// Where on a mesh of a known shape its error sits.
#pragma once

#include <vector>

#include "drape/geometry/rigid3.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::test {

/// Prints one line per kind of place (by the distance from the mesh's border, from the truth's creases, by
/// how many of the scanners saw it within 75 degrees): its share of the surface and of the squared error, RMS
/// and mean signed error (positive: outside of the truth) in spacings.
void print_error_places(const TriangleMesh& made, const TriangleMesh& truth,
                        const std::vector<Rigid3>& world_from_scanner, double spacing);

}  // namespace drape::test
