// What cleaning took from a scan, as a picture.
#pragma once

#include "drape/geometry/image.hpp"
#include "drape/geometry/range_scan.hpp"

namespace drape::stages {

/// RGB contact sheet of two rows, before and after: each from where the scanner stood (any side, where that
/// is unknown) and from a right angle to that. What was dropped is red in the first row. `cleaned` holds
/// points of `raw`, in the same order and unchanged. Large scans are drawn by a part of their points.
[[nodiscard]] Image8 cleaning_picture(const RangeScan& raw, const RangeScan& cleaned);

}  // namespace drape::stages
