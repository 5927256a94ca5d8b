// How rough, how directed and how one-sided the brightness changes around each pixel.
#pragma once

#include "lab_image.hpp"

namespace drape::segmentation {

/// Three channels per pixel, each about 0..1: anisotropy x contrast, polarity x contrast, contrast; taken at
/// the scale at which the polarity settles. Carson, Belongie, Greenspan, Malik, "Blobworld" (PAMI 2002),
/// section 2; directions are rounded to 1/16 of a turn.
[[nodiscard]] ImageF texture_features(const ImageF& lab);

}  // namespace drape::segmentation
