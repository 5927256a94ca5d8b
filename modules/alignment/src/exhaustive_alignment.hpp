// The thesis's method, from mesh and stencil to camera.
#pragma once

#include "drape/alignment/align.hpp"

namespace drape::alignment {

/// Method::exhaustive of align_photo.
[[nodiscard]] Alignment align_exhaustively(const TriangleMesh& mesh, const PhotoEvidence& evidence,
                                           const AlignOptions& options, const Progress& progress);

}  // namespace drape::alignment
