// The two ways to measure how far apart samples lie; see point_spacing.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "drape/geometry/ordered_points.hpp"
#include "drape/geometry/range_scan.hpp"

namespace drape::ingest {

/// By the neighbours on the grid; nothing without one, or where it has no neighbours.
[[nodiscard]] std::optional<double> lattice_spacing(const RangeScan& scan);

/// By the nearest points in space, at some ten thousand places; as if those points were not there whose
/// `dropped`, in the caller's order, is not 0.
[[nodiscard]] double neighbor_spacing(const OrderedPoints& points,
                                      const std::vector<std::uint8_t>& dropped = {});

}  // namespace drape::ingest
