// Points along a space-filling curve: neighbours in space become neighbours in memory.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace drape {

/// The indices of the points in Morton (1966) order of their bounding box, 21 bits an axis; equal points lie
/// side by side, the lower index first. Every stride-th of them is an even sample in space. The points must
/// be finite.
[[nodiscard]] std::vector<std::uint32_t> morton_order(std::span<const Eigen::Vector3d> points);

}  // namespace drape
