// Filters that look at a point's place, its return, or how many others are near it. 1 flags a point to drop.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "drape/geometry/range_scan.hpp"

namespace drape::ingest {

/// Points outside of the box: its least corner, then its greatest one, six numbers; none if it has no
/// numbers.
[[nodiscard]] std::vector<std::uint8_t> outside_of_box(const RangeScan& scan, std::span<const double> box);

/// Points whose return is weaker than `least` or stronger than `most`; none where the scan has no
/// intensities.
[[nodiscard]] std::vector<std::uint8_t> outside_of_intensities(const RangeScan& scan, double least,
                                                               double most);

/// All but the most confident point of each voxel of edge `voxel`; of equal ones the first is kept.
[[nodiscard]] std::vector<std::uint8_t> all_but_best_seen(const PointCloud& cloud, double voxel);

}  // namespace drape::ingest
