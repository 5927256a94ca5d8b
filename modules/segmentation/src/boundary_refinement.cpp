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
  if (found.size() == 1) return found;
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
  parallel_for(static_cast<std::size_t>(small.height()), 4, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < small.width(); ++x) {
        const std::vector<LocalColor> near = local_colors(small, small_lab, x, y);
        const int left = first(x, small.width(), rgb.width());
        const int right = first(x + 1, small.width(), rgb.width());
        const int top = first(y, small.height(), rgb.height());
        const int bottom = first(y + 1, small.height(), rgb.height());
        Image8 block(right - left, bottom - top, 3);
        ImageF lab;
        if (near.size() > 1) {
          for (int py = top; py < bottom; ++py)
            std::copy_n(&rgb.at(left, py), 3 * (right - left), block.row(py - top).begin());
          lab = lab_image(block);
        }
        for (int py = top; py < bottom; ++py)
          for (int px = left; px < right; ++px) {
            std::int32_t best = small.at(x, y);
            float least = std::numeric_limits<float>::max();
            if (near.size() > 1)
              for (const LocalColor& c : near) {
                const float d = squared_difference(&lab.at(px - left, py - top), c.lab.data());
                if (d >= least) continue;
                least = d;
                best = c.label;
              }
            full.at(px, py) = best;
          }
      }
  });
  return full;
}

}  // namespace drape::segmentation
