// Connected regions of a label image, and which ones touch.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "lab_image.hpp"

namespace drape::segmentation {

struct Region {
  int pixels = 0;
  std::array<float, 3> lab{};  // mean colour
  float x = 0;                 // centroid
  float y = 0;
  int border_pixels = 0;         // pixels on the picture's border
  std::map<int, int> neighbors;  // region -> pixel sides in common
};

/// Every 4-connected part of equal labels becomes a region of its own, numbered in reading order.
[[nodiscard]] Labels connected_regions(const Labels& labels);

/// Labels must be 0 .. n-1, each used.
[[nodiscard]] std::vector<Region> region_graph(const Labels& labels, const ImageF& lab);

/// Joins every region under least_pixels with the neighbour of the most similar mean colour, smallest first,
/// then neighbours whose mean colours differ by less than `least_difference`. Numbered in reading order.
[[nodiscard]] Labels merged_regions(const Labels& labels, const ImageF& lab, double least_pixels,
                                    double least_difference);

/// Renumbers so that region 0 has the most pixels (ties: reading order).
[[nodiscard]] Labels largest_first(const Labels& labels);

}  // namespace drape::segmentation
