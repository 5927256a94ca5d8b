// How much each pixel stands out from what surrounds the object.
#pragma once

#include "hints.hpp"
#include "lab_image.hpp"

namespace drape::segmentation {

/// 0 (background) .. 1 (object) per pixel, constant over patches of like colour; all 0 if the picture has no
/// contrast. Background is what the border of the picture (or of the box) hangs together with: robust
/// background detection and the least-squares problem of Zhu, Liang, Wei, Sun, "Saliency Optimization from
/// Robust Background Detection" (CVPR 2014); a click adds what lies near it in geodesic colour distance to
/// the foreground.
[[nodiscard]] ImageF object_evidence(const ImageF& lab, const Hints& hints);

}  // namespace drape::segmentation
