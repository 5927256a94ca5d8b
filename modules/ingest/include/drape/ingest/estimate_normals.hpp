// Surface normals of a scan.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "drape/geometry/range_scan.hpp"

namespace drape::ingest {

/// Unit normals, one per point, from a plane through the neighbourhood of each (total least squares).
/// Neighbours are those on the scan's grid, up to `radius_spacings` cells away and not across a depth edge;
/// where there is no grid, or a point has too few such neighbours, the nearest points in space, as many as a
/// disc of that radius holds. They point towards the scanner where the view is known or the grid shows its
/// axis; else they are made consistent along a minimum spanning tree (Hoppe et al. 1992, section 3.3) and,
/// per connected part, outward. The points must be finite. Measures the spacing if the scan does not state
/// it.
[[nodiscard]] std::vector<Eigen::Vector3f> estimate_normals(const RangeScan& scan,
                                                            double radius_spacings = 2.5);

/// The same where the spacing and the points' morton_order are known.
[[nodiscard]] std::vector<Eigen::Vector3f> estimate_normals(const RangeScan& scan, double spacing,
                                                            std::span<const std::uint32_t> order,
                                                            double radius_spacings = 2.5);

}  // namespace drape::ingest
