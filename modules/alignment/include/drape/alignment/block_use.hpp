// What cameras that are given mean.
#pragma once

namespace drape::alignment {

/// What the cameras of `input.cameras` are.
enum class BlockUse {
  automatic,  // those of drape's own cameras.json are given, those of other programs' files a block
  given,      // in the frame of the scans or the mesh
  similarity  // known among themselves alone: align_block brings them to the mesh
};

}  // namespace drape::alignment
