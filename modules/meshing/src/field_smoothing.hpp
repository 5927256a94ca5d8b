// Noise out of the fused field.
#pragma once

#include <cstddef>

#include "fused_field.hpp"
#include "fusion_blocks.hpp"

namespace drape::meshing {

/// Rounds of smoothing: some for noise, none where there is little. `noise_voxels` is the deviation of the
/// samples across the surface before they were denoised, in voxels.
[[nodiscard]] int smoothing_rounds(double noise_voxels);

/// Appends the blocks of `raw` from the end of `smooth` to `end`, smoothed: the distances near the surface
/// move by a weighted mean of their second differences in the 13 directions through the 3 x 3 x 3 voxels
/// round them, which leaves what is plane where it is (anisotropic diffusion, Perona and Malik 1990: a second
/// difference as large as those at a crease has no weight, so that smoothing runs along it and not across
/// it). Only evidence counts: where one of two opposite voxels is unknown or a guess, that direction is left
/// out. `raw` must hold these blocks' neighbours on all sides. `rounds` is 1 or 2.
void smooth_blocks(FusedField& smooth, const FusedField& raw, const FusionBlocks& blocks, int rounds,
                   std::size_t end);

}  // namespace drape::meshing
