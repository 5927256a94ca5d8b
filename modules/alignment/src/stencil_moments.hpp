// Where the object of a stencil is, and how large.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "drape/geometry/image.hpp"

namespace drape::alignment {

struct Moments {
  std::int64_t pixels = 0;
  Eigen::Vector2d center = Eigen::Vector2d::Zero();     // mean of the pixel centres (thesis 4.2.1)
  Eigen::Vector2d deviation = Eigen::Vector2d::Zero();  // standard deviation along x and y (thesis 4.2.2)
};

/// Of the object pixels at which `known` (same size) is 1. At most 1024 pixels a side.
[[nodiscard]] Moments moments_of(const Image8& stencil, const Image8& known);

}  // namespace drape::alignment
