// What the verdict on an outline rests on, measured about a pose.
#pragma once

#include "drape/alignment/align.hpp"
#include "noisy_outline.hpp"
#include "stencil_evidence.hpp"

namespace drape::alignment {

/// At the evidence's last level; `noise` is in that level's pixels. `object_px` is the longer side of the
/// stencil's object. Margin and deviation are left to the verdict.
[[nodiscard]] OutlineFigures outline_figures(const OutlineMesh& mesh, const OutlinePose& pose,
                                             const StencilEvidence& evidence, const OutlineNoise& noise,
                                             double object_px);

}  // namespace drape::alignment
