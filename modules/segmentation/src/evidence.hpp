// Which pixels show the object, from all that is known: the first guess that an outline is drawn from.
#pragma once

#include <cstdint>
#include <optional>

#include "backdrop.hpp"
#include "hints.hpp"
#include "lab_image.hpp"

namespace drape::segmentation {

struct Evidence {
  ImageF value;            // per pixel, 0 background .. 1 object; all 0 if nothing stands out
  float threshold = 0.5F;  // that parts the two
  Image8 unknown;          // 1 where neither is said; empty: nowhere
  bool is_a_cut = false;   // a minimum cut has been here already
};

/// By the backdrop, where one is given, within the box. Else, in this order: by scribbles, by the box, by the
/// click at several scales, by what stands out from the border.
[[nodiscard]] Evidence evidence_of(const Image8& rgb, const ImageF& lab,
                                   const std::optional<Backdrop>& backdrop, const Hints& hints,
                                   std::uint64_t seed);

/// Share of the outline's pixel sides across which the colour changes by an edge's step (12 Lab units within
/// 2 pixels); 0 if there is no outline.
[[nodiscard]] double edge_share(const Image8& shape, const ImageF& lab);

}  // namespace drape::segmentation
