// Islands and holes of a stencil.
#pragma once

#include <array>
#include <optional>

#include "drape/geometry/image.hpp"

namespace drape::segmentation {

/// Keeps the part that `must_hold` lies in, if it lies in one; else the largest part and every other that has
/// at least least_share of its pixels.
[[nodiscard]] Image8 without_islands(const Image8& given, double least_share,
                                     std::optional<std::array<int, 2>> must_hold);

/// Closes background parts that do not touch the border of the picture and have at most most_share of the
/// stencil's pixels.
[[nodiscard]] Image8 without_holes(const Image8& given, double most_share);

/// The shape, and unknown where `states` is in a part that touches it.
[[nodiscard]] Image8 with_unknown_beside(const Image8& shape, const Image8& states);

}  // namespace drape::segmentation
