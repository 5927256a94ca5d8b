// The points of all placed scans as one cloud.
#pragma once

#include <cstdint>
#include <span>

#include "drape/geometry/point_cloud.hpp"
#include "drape/geometry/range_scan.hpp"
#include "drape/geometry/rigid3.hpp"

namespace drape::registration {

/// Points of the scans that `use` does not mask with 0, in the world, one scan after the other, with these
/// normals (of each scan's points, in its frame). Where a scan has no confidences they are 1. Colours and
/// intensities are kept if every scan with points has them.
[[nodiscard]] PointCloud merged_cloud(std::span<const RangeScan> scans,
                                      std::span<const std::span<const Eigen::Vector3f>> normals,
                                      std::span<const Rigid3> world_from_scan,
                                      std::span<const std::uint8_t> use);

/// One point for each occupied cube of edge `cell`, or two where the surfaces in it face opposite ways (a
/// thin sheet seen from both sides): the mean of position, normal, colour and intensity weighted by
/// confidence, and the largest confidence. In the order of the cubes' first points.
[[nodiscard]] PointCloud thinned(const PointCloud& cloud, double cell);

}  // namespace drape::registration
