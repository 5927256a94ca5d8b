// The two steps of normal estimation: the plane, then the side.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "drape/geometry/range_scan.hpp"

namespace drape::ingest {

/// How many nearest points stand for a disc of this radius: pi r^2, at least 6.
[[nodiscard]] std::size_t neighbors_in_disc(double radius_spacings);

/// By the lattice where there is one; where it gives no plane, by the nearest points in space. Signs are
/// arbitrary.
[[nodiscard]] std::vector<Eigen::Vector3f> unoriented_normals(const RangeScan& scan, double spacing,
                                                              double radius_spacings);

/// Towards the scanner of `view`; where that is unknown, along a spanning tree.
[[nodiscard]] std::vector<Eigen::Vector3f> oriented_normals(std::vector<Eigen::Vector3f> normals,
                                                            const RangeScan& scan, const ScanView& view);

}  // namespace drape::ingest
