// Where on a mesh of a known shape its error sits.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "drape/geometry/rigid3.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::test {

struct SurfacePoints {
  std::vector<Eigen::Vector3d> positions;
  std::vector<std::size_t> faces;  // of each
};
/// Uniform on the surface.
[[nodiscard]] SurfacePoints spread_points(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed);

/// Prints one line per kind of place (by the distance from the mesh's border, from the truth's creases, by
/// how many of the scanners saw it within 75 degrees): its share of the surface and of the squared error, RMS
/// and mean signed error (positive: outside of the truth) in spacings.
void print_error_places(const TriangleMesh& made, const TriangleMesh& truth,
                        const std::vector<Rigid3>& world_from_scanner, double spacing);

}  // namespace drape::test
