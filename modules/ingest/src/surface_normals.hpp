// The two steps of normal estimation: the plane, then the side.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "drape/geometry/range_scan.hpp"

namespace drape::ingest {

/// How many nearest points stand for a disc of this radius: pi r^2, at least 6.
[[nodiscard]] std::size_t neighbors_in_disc(double radius_spacings);

/// By the lattice where there is one; where it gives no plane, by the nearest points in space, for which the
/// points' morton_order is needed. Signs are arbitrary.
[[nodiscard]] std::vector<Eigen::Vector3f> unoriented_normals(const RangeScan& scan, double spacing,
                                                              std::span<const std::uint32_t> order,
                                                              double radius_spacings);

/// Towards the scanner of `view`; where that is unknown, along a spanning tree of the points, for which their
/// morton_order is needed.
[[nodiscard]] std::vector<Eigen::Vector3f> oriented_normals(std::vector<Eigen::Vector3f> normals,
                                                            const RangeScan& scan, const ScanView& view,
                                                            std::span<const std::uint32_t> order);

}  // namespace drape::ingest
