// Which side of the surface a normal points to.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "drape/geometry/ordered_points.hpp"
#include "drape/geometry/range_scan.hpp"

namespace drape::ingest {

/// The normals turned into the half space of the scanner; the view must be known.
[[nodiscard]] std::vector<Eigen::Vector3f> oriented_to_view(std::vector<Eigen::Vector3f> normals,
                                                            std::span<const Eigen::Vector3d> points,
                                                            const ScanView& view);

/// The normals made consistent over a minimum spanning tree of the neighbourhood graph, whose edges cost 1 -
/// |n_i * n_j| (Hoppe et al. 1992, section 3.3). Each connected part then points outward: to the side for
/// which the sum of n * (p - centroid) is positive (three times the volume, for a closed surface). `normals`
/// and the result are in the caller's order of `points`.
[[nodiscard]] std::vector<Eigen::Vector3f> oriented_by_spanning_tree(std::vector<Eigen::Vector3f> normals,
                                                                     const OrderedPoints& points);

}  // namespace drape::ingest
