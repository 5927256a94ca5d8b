// What is asked of segmentation: checked, and brought to the working size.
#pragma once

#include <array>
#include <optional>

#include "drape/segmentation/segment_photo.hpp"
#include "hints.hpp"

namespace drape::segmentation {

/// Error{input} or Error{config} as segment_photo states.
void check(const Image8& rgb, const Image8& mask, const PhotoRegion& region, const SegmentOptions& options);

/// The region in pixels of `small`, which is `photo` reduced.
[[nodiscard]] Hints hints_of(const PhotoRegion& region, const Image8& photo, const Image8& small);

[[nodiscard]] std::optional<std::array<int, 2>> pixel_of_click(const PhotoRegion& region,
                                                               const Image8& photo);

}  // namespace drape::segmentation
