// The outline's method, from mesh and stencil to camera and verdict.
#pragma once

#include "drape/alignment/align.hpp"
#include "pose_search.hpp"

namespace drape::alignment {

/// The mesh as poses are sought for it: made once, whatever kinds of evidence are tried. Keeps a reference.
struct SoughtMesh {
  explicit SoughtMesh(const TriangleMesh& whole);

  const TriangleMesh& mesh;
  UnitSphere sphere;
  MeshLevels levels;
};

/// Method::silhouette of align_photo, by the one kind of evidence that the options name.
[[nodiscard]] Alignment align_silhouette(const SoughtMesh& sought, const PhotoEvidence& evidence,
                                         const AlignOptions& options, const Progress& progress);

}  // namespace drape::alignment
