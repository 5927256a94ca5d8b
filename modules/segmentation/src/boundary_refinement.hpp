// Labels of a reduced picture, outlined on the full one.
#pragma once

#include "lab_image.hpp"

namespace drape::segmentation {

/// `small` holds labels of the reduced `rgb`, `small_lab` its colours. Away from label boundaries a pixel
/// gets the label of the reduced pixel it lies in; near one, whichever of the nearby labels has the more
/// similar colours there. Each side of the boundary is told by its colours close by, not by its segment's
/// mean.
[[nodiscard]] Labels refined_labels(const Labels& small, const ImageF& small_lab, const Image8& rgb);

}  // namespace drape::segmentation
