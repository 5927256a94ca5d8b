// The poses that scans come with.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drape/geometry/range_scan.hpp"
#include "drape/geometry/rigid3.hpp"
#include "drape/registration/register_scans.hpp"

namespace drape::registration {

/// "bun045.ply", or "room.e57 (scan 3)" where it is not the first of its file.
[[nodiscard]] std::string label(const RangeScan& scan);

/// The poses that are given, else stated by the scans themselves. Scans without pose or points are not
/// placed.
[[nodiscard]] std::vector<PlacedScan> place_given(
    std::span<const RangeScan> scans, std::span<const std::optional<Rigid3>> given_world_from_scan);

}  // namespace drape::registration
