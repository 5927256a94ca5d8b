// How far one surface is from another.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "drape/geometry/triangle_mesh.hpp"
#include "drape/metrics/distribution.hpp"

namespace drape::metrics {

/// Which points of a mesh are measured.
struct SurfacePoints {
  std::size_t samples = 0;  // area-uniform samples; 0: the vertices that faces use
  std::uint64_t seed = 1;
};

/// Distance of every point to the nearest point of the surface (point to triangle), in their common unit.
/// Error{input} without points, for a point that is not finite, or a mesh without area.
[[nodiscard]] std::vector<double> distances_to_surface(std::span<const Eigen::Vector3d> points,
                                                       const TriangleMesh& surface);

/// Mean, RMS, 95 % and maximum of these distances. One-sided: what the surface has and the points do not is
/// not seen.
[[nodiscard]] Distribution surface_distance(std::span<const Eigen::Vector3d> points,
                                            const TriangleMesh& surface);
/// From the points of one mesh to the other. Error{input} if either has no area.
[[nodiscard]] Distribution surface_distance(const TriangleMesh& from, const TriangleMesh& to,
                                            const SurfacePoints& points = {});

/// Both directions: `missing` grows with what `made` lacks, `extra` with what it has too much.
struct TwoWayDistance {
  Distribution extra;    // from the mesh that was made to the true one
  Distribution missing;  // from the true mesh to the one that was made

  /// The larger of the two maxima (sampled Hausdorff distance; Cignoni et al., "Metro", 1998).
  [[nodiscard]] double hausdorff() const { return extra.max > missing.max ? extra.max : missing.max; }
};
[[nodiscard]] TwoWayDistance two_way_distance(const TriangleMesh& made, const TriangleMesh& truth,
                                              const SurfacePoints& points = {});

}  // namespace drape::metrics
