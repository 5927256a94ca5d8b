// Limits of the verdict on an outline, of one photo and of a block alike.
#pragma once

namespace drape::alignment {

inline constexpr double least_inliers = 0.5;  // of the outline: with less the object is another one
inline constexpr double good_inliers = 0.85;
inline constexpr double least_margin = 0.03;   // of the score, over the best other pose
inline constexpr double light_explains = 0.7;  // of the photo's inside: then what is left is noise

}  // namespace drape::alignment
