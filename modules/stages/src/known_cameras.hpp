// What input.cameras says of the photos.
#pragma once

#include <optional>
#include <vector>

#include "drape/alignment/align.hpp"
#include "drape/io/records.hpp"
#include "drape/pipeline/stage.hpp"

namespace drape::stages {

/// A photo's camera, in the workspace's frame.
struct KnownCamera {
  std::optional<io::CameraRecord> given;         // as it is
  std::optional<alignment::Alignment> by_block;  // with the others of its block
};

/// One per photo of the input, empty for photos that input.cameras does not name (all, without it). By
/// align.block the cameras are those of the scans' or mesh's frame, or a block's that is brought to the mesh
/// here, by the stencils of the photos that have one.
[[nodiscard]] std::vector<KnownCamera> known_cameras(const TriangleMesh& mesh,
                                                     const io::WorkspaceFrame& frame,
                                                     const alignment::AlignOptions& options,
                                                     pipeline::StageRun& run, const Progress& progress);

}  // namespace drape::stages
