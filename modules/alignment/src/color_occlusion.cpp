#include "color_occlusion.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "color_model.hpp"

namespace drape::alignment {
namespace {

constexpr double surroundings = 0.35;  // of the object's size
constexpr float others_log_ratio = -1;
constexpr double window_share = 0.02;        // of the object's size: half a side of what is averaged
constexpr double least_hidden_share = 0.01;  // of the object's area

// Sums over all pixels above and to the left.
ImageF summed(const ImageF& image) {
  ImageF sums(image.width() + 1, image.height() + 1, 1, 0.F);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      sums.at(x + 1, y + 1) = image.at(x, y) + sums.at(x, y + 1) + sums.at(x + 1, y) - sums.at(x, y);
  return sums;
}

float box_sum(const ImageF& sums, int x, int y, int radius) {
  const int left = std::max(0, x - radius);
  const int top = std::max(0, y - radius);
  const int right = std::min(sums.width() - 1, x + radius + 1);
  const int bottom = std::min(sums.height() - 1, y + radius + 1);
  return sums.at(right, bottom) - sums.at(left, bottom) - sums.at(right, top) + sums.at(left, top);
}

// The connected parts of `candidates` that touch a pixel outside of `stencil` and have `least` pixels.
Image8 parts_at_rim(const Image8& candidates, const BitImage& stencil, std::size_t least) {
  Image8 kept(candidates.width(), candidates.height(), 1, 0);
  Image8 seen = kept;
  std::vector<std::pair<int, int>> part;
  for (int y = 0; y < candidates.height(); ++y)
    for (int x = 0; x < candidates.width(); ++x) {
      if (candidates.at(x, y) == 0 || seen.at(x, y) != 0) continue;
      part.assign(1, {x, y});
      seen.at(x, y) = 1;
      bool at_rim = false;
      for (std::size_t i = 0; i < part.size(); ++i)
        for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
          const int u = part[i].first + dx;
          const int v = part[i].second + dy;
          at_rim |= !stencil.at(u, v);
          if (!candidates.contains(u, v) || candidates.at(u, v) == 0 || seen.at(u, v) != 0) continue;
          seen.at(u, v) = 1;
          part.emplace_back(u, v);
        }
      if (!at_rim || part.size() < least) continue;
      for (const auto& [u, v] : part) kept.at(u, v) = 1;
    }
  return kept;
}

}  // namespace

Image8 hidden_pixels(const ColorLevel& level, const OutlineDrawing& drawing) {
  const int width = level.window.width;
  const int height = level.window.height;
  const BitImage& stencil = drawing.stencil();
  Image8 candidates(width, height, 1, 0);
  const PixelRegion around = region_about(stencil, surroundings);
  if (around.right <= around.left) return candidates;
  const ColorModel model(level, stencil, around, true);
  ImageF ratio(width, height, 1, 0.F);
  ImageF inside(width, height, 1, 0.F);
  double area = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (!stencil.at(x, y)) continue;
      ratio.at(x, y) = model.log_ratio(x, y, model.sector_of({x + 0.5, y + 0.5}));
      inside.at(x, y) = 1;
      ++area;
    }
  const ImageF ratios = summed(ratio);
  const ImageF counts = summed(inside);
  const PixelRegion box = region_about(stencil, 0);
  const int radius =
      std::max(1, static_cast<int>(window_share * std::max(box.right - box.left, box.bottom - box.top)));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (stencil.at(x, y) &&
          box_sum(ratios, x, y, radius) < others_log_ratio * box_sum(counts, x, y, radius))
        candidates.at(x, y) = 1;
  return parts_at_rim(candidates, stencil, static_cast<std::size_t>(least_hidden_share * area));
}

}  // namespace drape::alignment
