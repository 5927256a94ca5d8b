// Rectangles on square pages.
#pragma once

#include <span>
#include <vector>

namespace drape::texturing {

struct Rectangle {
  int width;
  int height;
};

struct Placement {
  int page = 0;
  int left = 0;
  int top = 0;
};

struct Packing {
  std::vector<Placement> placements;  // as the rectangles given
  std::vector<int> sides;             // of each page
};

/// Without overlap: on one page that is as small as it goes (sides are multiples of 64), else on as many of
/// most_side as it takes. No rectangle is larger than a page. (stb_rect_pack: skyline, bottom left.)
[[nodiscard]] Packing packed(std::span<const Rectangle> rectangles, int most_side);

}  // namespace drape::texturing
