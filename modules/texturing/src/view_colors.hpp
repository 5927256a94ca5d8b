// What colours the photos show a surface in, and which of them cannot be right.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "painted_faces.hpp"
#include "photo_colors.hpp"

namespace drape::texturing {

/// Sets every candidate's log_color: of the photo's pixels under the face, plus `exposure` of its view.
void look_up_colors(PaintedFaces& surface, std::span<const PhotoSight> sights,
                    std::span<const PhotoColors> colors);

/// Per view, what to add to log light so that photos agree where they see the same surface: least squares
/// over the medians of all pairs, their mean 0. Zero for views that share nothing with another.
[[nodiscard]] std::vector<Eigen::Vector3f> matched_exposures(const PaintedFaces& surface, std::size_t views);
void apply_exposures(PaintedFaces& surface, std::span<const Eigen::Vector3f> exposures);

/// Takes candidates away that three or more photos outvote: a hand, a highlight, a shadow of one photo
/// (consistency test as in Waechter, Moehrle, Goesele, "Let There Be Color!", ECCV 2014, section 4.1, about
/// the median). Returns how many.
std::size_t drop_outliers(PaintedFaces& surface);

}  // namespace drape::texturing
