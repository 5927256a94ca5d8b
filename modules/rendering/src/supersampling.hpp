// Averages of samples, in linear light.
#pragma once

#include <cstdint>
#include <span>

#include "drape/geometry/image.hpp"

namespace drape::rendering {

/// Fills the rectangle of `picture` (RGB) at (x, y) of width x height pixels with the means of samples x
/// samples RGBA values (sRGB-encoded; alpha is dropped), given row by row from the rectangle's top.
void average_samples(std::span<const std::uint32_t> rgba, int samples, Image8& picture, int x, int y,
                     int width, int height);

}  // namespace drape::rendering
