// How well two stencils of one photo agree.
#pragma once

#include <cstddef>
#include <optional>

#include "drape/geometry/image.hpp"
#include "drape/metrics/distribution.hpp"

namespace drape::metrics {

/// Pixels that are unknown in either stencil are left out.
struct StencilOverlap {
  std::size_t both = 0;
  std::size_t only_first = 0;
  std::size_t only_second = 0;

  [[nodiscard]] std::size_t united() const { return both + only_first + only_second; }
  /// 100 * intersection / union; 0 where neither stencil has an object pixel.
  [[nodiscard]] double percent() const {
    return united() == 0 ? 0.0 : 100.0 * static_cast<double>(both) / static_cast<double>(united());
  }
};

/// Error{input} if the sizes differ or a stencil has more than one channel.
[[nodiscard]] StencilOverlap stencil_overlap(const Image8& first, const Image8& second);

/// Distances in pixels between the two outlines, from each to the other, all in one distribution. An outline
/// is made of the middles of the pixel sides between object and background. The image's border is none (the
/// object goes on behind it), nor is the border of what is unknown in either stencil. Nothing if either has
/// no outline. Error{input} as above.
[[nodiscard]] std::optional<Distribution> boundary_error_px(const Image8& first, const Image8& second);

}  // namespace drape::metrics
