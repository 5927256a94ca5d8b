// One photo for each face.
#pragma once

#include "painted_faces.hpp"

namespace drape::texturing {

inline constexpr int no_view = -1;

/// Per face the view that paints it, or no_view. Starts from the best candidate of each face, then lets every
/// face prefer what its neighbours took, until nothing changes (iterated conditional modes: Besag 1986).
[[nodiscard]] std::vector<int> chosen_views(const PaintedFaces& surface);

/// The candidate of a face for a view that chosen_views gave it.
[[nodiscard]] const Candidate& candidate_of(const PaintedFaces& surface, std::size_t face, int view);

}  // namespace drape::texturing
