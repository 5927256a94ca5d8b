// What is said of each segment.
#pragma once

#include <vector>

#include "drape/segmentation/segment_photo.hpp"
#include "lab_image.hpp"

namespace drape::segmentation {

/// One entry a label; `chosen` where most of it is object in `shape`. All three have the same size. Leaves
/// yaml_that_picks_it empty.
[[nodiscard]] std::vector<SegmentInfo> segments_of(const Labels& labels, const Image8& rgb,
                                                   const Image8& shape);

}  // namespace drape::segmentation
