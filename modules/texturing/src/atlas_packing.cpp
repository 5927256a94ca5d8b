#include "atlas_packing.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#define STB_RECT_PACK_IMPLEMENTATION
#define STBRP_STATIC
#include <stb/stb_rect_pack.h>

namespace drape::texturing {
namespace {

constexpr int granule = 64;

// Of the rectangles named by id those that fit on one page; the others are left.
void pack_page(std::vector<stbrp_rect>& rectangles, int side) {
  std::vector<stbrp_node> nodes(static_cast<std::size_t>(side));
  stbrp_context context;
  stbrp_init_target(&context, side, side, nodes.data(), side);
  stbrp_pack_rects(&context, rectangles.data(), static_cast<int>(rectangles.size()));
}

void take_packed(std::vector<stbrp_rect>& left, int page, Packing& packing) {
  for (const stbrp_rect& r : left)
    if (r.was_packed != 0) packing.placements[static_cast<std::size_t>(r.id)] = {page, r.x, r.y};
  std::erase_if(left, [](const stbrp_rect& r) { return r.was_packed != 0; });
}

}  // namespace

Packing packed(std::span<const Rectangle> rectangles, int most_side) {
  Packing packing;
  packing.placements.resize(rectangles.size());
  std::vector<stbrp_rect> left;
  double area = 0;
  int longest = 1;
  for (std::size_t i = 0; i < rectangles.size(); ++i) {
    const auto [width, height] = rectangles[i];
    assert(width <= most_side && height <= most_side);
    left.push_back({static_cast<int>(i), width, height, 0, 0, 0});
    area += static_cast<double>(width) * height;
    longest = std::max({longest, width, height});
  }
  if (left.empty()) return packing;
  double wanted = std::max(std::sqrt(area), static_cast<double>(longest));
  while (!left.empty()) {
    const double rounded = std::ceil(wanted / granule) * granule;
    const int side = static_cast<int>(std::min<double>(most_side, rounded));
    std::vector<stbrp_rect> tried = left;
    pack_page(tried, side);
    const bool all =
        std::all_of(tried.begin(), tried.end(), [](const stbrp_rect& r) { return r.was_packed != 0; });
    if (!all && side < most_side) {
      constexpr double growth = 1.06;
      wanted = std::max(wanted * growth, side + 1.0);
      continue;
    }
    left = std::move(tried);
    take_packed(left, static_cast<int>(packing.sides.size()), packing);
    packing.sides.push_back(side);
    area = 0;
    longest = 1;
    for (const stbrp_rect& r : left) {
      area += static_cast<double>(r.w) * r.h;
      longest = std::max({longest, r.w, r.h});
    }
    wanted = std::max(std::sqrt(area), static_cast<double>(longest));
  }
  return packing;
}

}  // namespace drape::texturing
