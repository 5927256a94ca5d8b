#include "boundary_refinement.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "drape/base/parallel.hpp"

namespace drape::segmentation {
namespace {

constexpr int window = 3;  // radius, in reduced pixels, within which a label's colours are averaged

struct LocalColor {
  std::int32_t label = 0;
  std::array<float, 3> lab{};
};

// Whether a reduced pixel and all about it are of one label.
bool inside_one_label(const Labels& small, int x, int y) {
  const std::int32_t label = small.at(x, y);
  for (int ny = std::max(0, y - 1); ny <= std::min(small.height() - 1, y + 1); ++ny)
    for (int nx = std::max(0, x - 1); nx <= std::min(small.width() - 1, x + 1); ++nx)
      if (small.at(nx, ny) != label) return false;
  return true;
}

// The labels within a reduced pixel's 3 x 3 neighbours, each with its mean colour in a wider window.
std::vector<LocalColor> local_colors(const Labels& small, const ImageF& lab, int x, int y) {
  std::vector<LocalColor> found;
  std::vector<int> counts;
  const auto entry = [&](std::int32_t label) {
    return std::find_if(found.begin(), found.end(), [&](const LocalColor& c) { return c.label == label; });
  };
  for (int ny = std::max(0, y - 1); ny <= std::min(small.height() - 1, y + 1); ++ny)
    for (int nx = std::max(0, x - 1); nx <= std::min(small.width() - 1, x + 1); ++nx)
      if (entry(small.at(nx, ny)) == found.end()) found.push_back({small.at(nx, ny), {}});
  counts.assign(found.size(), 0);
  for (int ny = std::max(0, y - window); ny <= std::min(small.height() - 1, y + window); ++ny)
    for (int nx = std::max(0, x - window); nx <= std::min(small.width() - 1, x + window); ++nx) {
      const auto at = entry(small.at(nx, ny));
      if (at == found.end()) continue;
      ++counts[static_cast<std::size_t>(at - found.begin())];
      for (std::size_t c = 0; c < 3; ++c) at->lab[c] += lab.at(nx, ny, static_cast<int>(c));
    }
  for (std::size_t i = 0; i < found.size(); ++i)
    for (float& channel : found[i].lab) channel /= static_cast<float>(counts[i]);
  return found;
}

}  // namespace

Labels refined_labels(const Labels& small, const ImageF& small_lab, const Image8& rgb) {
  if (small.width() == rgb.width() && small.height() == rgb.height()) return small;
  Labels full(rgb.width(), rgb.height(), 1, 0);
  const auto first = [](int i, int from, int to) {  // first full pixel whose centre lies in reduced pixel i
    return static_cast<int>((static_cast<std::int64_t>(2 * i) * to + from) / (2 * from));
  };
  // The block of full pixels of one reduced pixel: all of its label, or where labels meet, each of the label
  // with the nearest colour.
  const auto refine_block = [&](int x, int y) {
    const int left = first(x, small.width(), rgb.width());
    const int right = first(x + 1, small.width(), rgb.width());
    const int top = first(y, small.height(), rgb.height());
    const int bottom = first(y + 1, small.height(), rgb.height());
    if (inside_one_label(small, x, y)) {
      for (int py = top; py < bottom; ++py) std::fill_n(&full.at(left, py), right - left, small.at(x, y));
      return;
    }
    const std::vector<LocalColor> near = local_colors(small, small_lab, x, y);
    Image8 block(right - left, bottom - top, 3);
    for (int py = top; py < bottom; ++py)
      std::copy_n(&rgb.at(left, py), 3 * (right - left), block.row(py - top).begin());
    const ImageF lab = lab_image(block);
    for (int py = top; py < bottom; ++py)
      for (int px = left; px < right; ++px)
        full.at(px, py) =
            std::min_element(near.begin(), near.end(),
                             [&, color = &lab.at(px - left, py - top)](const auto& a, const auto& b) {
                               return squared_difference(color, a.lab.data()) <
                                      squared_difference(color, b.lab.data());
                             })
                ->label;
  };
  parallel_for(static_cast<std::size_t>(small.height()), 4, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < small.width(); ++x) refine_block(x, y);
  });
  return full;
}

}  // namespace drape::segmentation
