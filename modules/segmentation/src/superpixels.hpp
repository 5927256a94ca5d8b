// Small compact patches of like colour.
#pragma once

#include "lab_image.hpp"

namespace drape::segmentation {

/// About `count` connected patches, labelled 0, 1, ... in reading order (SLIC: Achanta et al., PAMI 2012).
[[nodiscard]] Labels superpixels(const ImageF& lab, int count);

}  // namespace drape::segmentation
