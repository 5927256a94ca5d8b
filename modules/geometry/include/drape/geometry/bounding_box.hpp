// Axis-aligned boxes.
#pragma once

#include <Eigen/Geometry>
#include <span>

namespace drape {

using BoundingBox = Eigen::AlignedBox3d;

/// Of the finite points; empty (isEmpty()) without any.
[[nodiscard]] BoundingBox bounding_box(std::span<const Eigen::Vector3d> points);

}  // namespace drape
