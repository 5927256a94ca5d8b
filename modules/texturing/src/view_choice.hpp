// One photo for each face.
#pragma once

#include "painted_faces.hpp"

namespace drape::texturing {

inline constexpr int no_view = -1;

/// Per face the view that paints it, or no_view: the least of how much worse than its best photo each face is
/// painted, by its area, plus what seams cost by their length, more where the photos disagree (Lempitsky and
/// Ivanov, "Seamless Mosaicing of Image-Based Texture Maps", CVPR 2007, equation 1). Only the best few
/// photos of a face are weighed.
[[nodiscard]] std::vector<int> chosen_views(const PaintedFaces& surface);

/// The candidate of a face for a view that chosen_views gave it.
[[nodiscard]] const Candidate& candidate_of(const PaintedFaces& surface, std::size_t face, int view);

/// Takes from faces the photo chosen for them where an exact ray from their middle meets something: photos'
/// pixels are too coarse to tell slivers beside what hides them.
void drop_hidden(const PaintedFaces& surface, std::span<const PhotoSight> sights, std::vector<int>& chosen);

}  // namespace drape::texturing
