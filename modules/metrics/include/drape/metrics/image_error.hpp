// How alike two pictures are.
#pragma once

#include <optional>

#include "drape/geometry/image.hpp"

namespace drape::metrics {

/// Peak signal to noise ratio in dB over all channels of the pixels whose mask is 255 (an empty mask: of all
/// pixels). Infinity for equal pictures; nothing if the mask has no such pixel. Error{input} if the sizes or
/// the channels differ, or the mask has not one channel.
[[nodiscard]] std::optional<double> psnr_db(const Image8& first, const Image8& second,
                                            const Image8& mask = {});

/// Mean structural similarity (Wang, Bovik, Sheikh, Simoncelli, "Image quality assessment: from error
/// visibility to structural similarity", 2004): Gaussian window of 11 x 11 pixels with a deviation of 1.5,
/// K1 = 0.01, K2 = 0.03, on luma (Rec. 601) as theirs; -1..1, 1 for equal pictures. What lies outside the
/// mask or the picture has no weight in any window, so it does not matter at all. Nothing and Error{input} as
/// above.
[[nodiscard]] std::optional<double> ssim(const Image8& first, const Image8& second, const Image8& mask = {});

}  // namespace drape::metrics
