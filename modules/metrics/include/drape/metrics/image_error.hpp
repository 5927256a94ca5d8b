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

/// Local mean squared error of an albedo (Grosse, Johnson, Adelson, Freeman, "Ground truth dataset and
/// baseline evaluations for intrinsic image algorithms", ICCV 2009): in windows of window_px x window_px
/// pixels, half overlapping, the squared difference in linear light after the factor that makes it least, of
/// the truth's squares, summed over all windows before dividing. Each channel has factors of its own, as
/// light has a tint. Only pixels whose mask is 255 count (an empty mask: all). 0 for equal pictures, 1 where
/// nothing is alike. Nothing and Error{input} as above; Error{input} for a window under 2 pixels.
[[nodiscard]] std::optional<double> local_albedo_error(const Image8& made, const Image8& truth,
                                                       const Image8& mask = {}, int window_px = 20);

}  // namespace drape::metrics
