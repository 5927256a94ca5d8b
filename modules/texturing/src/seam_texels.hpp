// Texels on the two sides of a seam, made to show the same colours along it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "drape/geometry/deep_image.hpp"

namespace drape::texturing {

/// An edge of the surface that lies at two places of the atlas: page and ends (in texels, centres at +0.5)
/// on either side, the same end first.
struct Seam {
  struct Side {
    std::uint32_t page;
    Eigen::Vector2d from;
    Eigen::Vector2d to;
  };
  std::array<Side, 2> sides;
};

/// Changes the texels that bilinear filters read along the seams as little as may be (least squares), so that
/// both sides show the same there: charts lie on different grids of texels, whose interpolation differs even
/// where their photos agree (Iwanicki, "Lighting technology of The Last of Us", SIGGRAPH talks 2013, solves
/// light maps so). Each page: RGB.
template <class Sample>
void match_texels_along(std::span<const Seam> seams, std::span<Image<Sample>* const> pages);
extern template void match_texels_along(std::span<const Seam> seams, std::span<Image8* const> pages);
extern template void match_texels_along(std::span<const Seam> seams, std::span<Image16* const> pages);

}  // namespace drape::texturing
