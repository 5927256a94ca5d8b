// What cleaning took from a scan, as a picture.
#pragma once

#include "drape/geometry/image.hpp"
#include "drape/geometry/range_scan.hpp"

namespace drape::stages {

/// RGB contact sheet of two rows, before and after: each from where the scanner stood (any side, where that
/// is unknown) and from a right angle to that. `up` is the input's axis that points up ('x', 'y', 'z'), which
/// is up in the picture where the scan has a pose; without one it is what is up for such scanners: y for
/// those that look along -z, -y (image rows) for those that look along z, else z. What was dropped is red in
/// the first row. `cleaned` holds points of `raw`, in the same order and unchanged. Large scans are drawn by
/// a part of their points.
[[nodiscard]] Image8 cleaning_picture(const RangeScan& raw, const RangeScan& cleaned, char up);

}  // namespace drape::stages
