// Places of a photo that seem to be of one paint.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "light_fit.hpp"

namespace drape::texturing {

/// Pairs of samples, from all over the photo, whose colours differ by brightness alone: light changes that
/// and paint seldom does, as all light of a photo has one colour here (chromaticity tells reflectance edges
/// from shading: Land and McCann's retinex for colour; far apart: Shen, Tan, Lin, "Intrinsic image
/// decomposition with non-local texture cues", CVPR 2008). Neighbours alone say little of light that changes
/// slowly where paint is speckled or the photo noisy. `own`: samples of one photo; several pairs each, chosen
/// at random. Paint that differs in brightness alone gets pairs too: whoever uses them must bear outliers.
[[nodiscard]] std::vector<LightPair> pairs_of_like_paint(const std::vector<LightSample>& samples,
                                                         std::span<const std::uint32_t> own);

}  // namespace drape::texturing
