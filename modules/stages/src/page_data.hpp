// What the script of a run's page works on.
#pragma once

#include <optional>

#include "drape/report/page.hpp"
#include "results.hpp"

namespace drape::stages {

/// Candidates of one photo that the page shows and offers.
inline constexpr std::size_t most_candidates = 6;

/// The light copy of the model with what the page needs to know of the photos and their cameras, as JSON:
///   object            name for fixes.yaml; batch: whether the run is one of a batch's objects
///   metres_per_unit   of the input; y_up_from_input: rotation to the model's axes, row by row
///   material_names    file name of the photo that a material shows; unseen_text: what unseen surface looks
///   like photos            name, width, height; keys of the pictures `picture` and `segments_picture`;
///   verdict; P_input,
///                     candidates: P_input, overlap_percent, verdict, picture; segments: label, area_percent,
///                     inside_px, chosen; regions: whether they, a box, a point or strokes can say where the
///                     object is (a mask says it)
/// P_input is the 3x4 projection from the input's coordinates to upright pixels, row by row: unlike those of
/// cameras.json it does not depend on the offset of the workspace's frame.
/// Without a light copy only what the photos need; nothing where there are no photos either.
[[nodiscard]] std::optional<report::ModelView> page_view(const Results& results,
                                                         const pipeline::RunResult& run);

}  // namespace drape::stages
