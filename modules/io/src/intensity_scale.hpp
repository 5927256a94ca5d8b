// Laser intensities of any scanner, brought to 0..1.
#pragma once

#include <span>
#include <vector>

namespace drape::io {

/// The formats do not say what unit intensities have, so the values tell: within 0..1 they stay; else within
/// 0..255, 0..65535 or -2048..2047 (Leica) they are taken as that range; else they are divided by the
/// largest. What is not finite becomes 0. `full_scale` is the value that means 1 where the type tells it (255
/// for bytes); 0 if it does not.
[[nodiscard]] std::vector<float> scaled_intensities(std::span<const double> values, double full_scale = 0);

}  // namespace drape::io
