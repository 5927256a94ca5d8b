// Noise out of the fused field.
#pragma once

#include <cstddef>
#include <span>

#include "fused_field.hpp"
#include "fusion_blocks.hpp"

namespace drape::meshing {

/// Shares of the way to go, one step after the other: two for noise, none where there is little. Under some
/// noise the second goes back, which gives shape back and little of the noise (Taubin 1995). `noise_voxels`
/// is the deviation of the samples across the surface before they were denoised, in voxels.
[[nodiscard]] std::span<const float> smoothing_steps(double noise_voxels);

/// Appends the blocks of `raw` from the end of `smooth` to `end`, smoothed: the distances near the surface
/// move by a weighted mean of their second differences in the 13 directions through the 3 x 3 x 3 voxels
/// round them, which leaves what is plane where it is (anisotropic diffusion, Perona and Malik 1990: a second
/// difference as large as those at a crease has no weight, so that smoothing runs along it and not across
/// it). Only evidence counts: where one of two opposite voxels is unknown or a guess, that direction is left
/// out. `raw` must hold these blocks' neighbours on all sides. At most two `steps`.
void smooth_blocks(FusedField& smooth, const FusedField& raw, const FusionBlocks& blocks,
                   std::span<const float> steps, std::size_t end);

}  // namespace drape::meshing
