// One focal length for all photos of one camera and zoom.
#pragma once

#include <optional>
#include <span>

#include "drape/alignment/align.hpp"

namespace drape::alignment {

/// What the photos say together, in lengths of a photo's longer side: photos of several sizes or orientations
/// are compared so. The mean of the logarithms over the accepted ones with a focal length of their own
/// finding, each weighted by the inverse of its variance, after those are left out that are further from the
/// weighted median than three of their deviations. Nothing for fewer than two. Give it to each photo as
/// AlignOptions::focal_px and align again.
[[nodiscard]] std::optional<double> shared_focal(std::span<const Alignment> photos);

}  // namespace drape::alignment
