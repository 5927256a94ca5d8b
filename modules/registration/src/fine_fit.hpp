// Two surfaces laid on each other with all that their points tell.
#pragma once

#include "drape/geometry/rigid3.hpp"
#include "scan_surface.hpp"

namespace drape::registration {

/// Moves `source` onto `target` from a place where they lie within `start_reach` of each other: distances
/// along the mean of both normals (Rusinkiewicz 2019), Tukey's weights with a reach that shrinks to what
/// spacing and noise explain. Smoothed, coarse scans drift along what hardly holds them; these do not.
[[nodiscard]] Rigid3 fit_finely(const ScanSurface& source, const ScanSurface& target,
                                const Rigid3& target_from_source_guess, double start_reach);

}  // namespace drape::registration
