// The outline's method, from mesh and stencil to camera and verdict.
#pragma once

#include "drape/alignment/align.hpp"

namespace drape::alignment {

/// Method::silhouette of align_photo, by the one kind of evidence that the options name.
[[nodiscard]] Alignment align_silhouette(const TriangleMesh& mesh, const PhotoEvidence& evidence,
                                         const AlignOptions& options, const Progress& progress);

}  // namespace drape::alignment
