// Real outlines, judged against cameras that the aligner never sees.
#pragma once

#include <nlohmann/json.hpp>

#include "drape/alignment/align.hpp"

namespace drape::lab {

/// The three photos of photos/lmo, with stencils drawn by their published cameras: how far from these the
/// cameras come out that are found from the stencils (self-consistency). Prints a line for each.
[[nodiscard]] nlohmann::json measure_lmo(const alignment::AlignOptions& options);

/// The photos of photos/dino with stencils by a threshold: a hull carved from every second one is aligned
/// with the others, one by one, and as blocks of 2, 4 and 6 (align_block; a block's program knows the lens,
/// and how the cameras stand to each other). Outlines fit a hull by construction, but those that carve it are
/// not those that it is tested on.
[[nodiscard]] nlohmann::json measure_dino(const alignment::AlignOptions& options);

}  // namespace drape::lab
