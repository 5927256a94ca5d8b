#include <algorithm>
#include <array>
#include <cmath>

#include "drape/segmentation/segment_photo.hpp"

namespace drape::segmentation {
namespace {

// Hues by the golden angle are far apart for neighbouring numbers.
std::array<std::uint8_t, 3> color_of(int label, bool bright) {
  const double hue = std::fmod(label * 0.618033988749895, 1.0) * 6;
  const double value = bright ? 1.0 : 0.55;
  const double saturation = bright ? 0.85 : 0.45;
  std::array<std::uint8_t, 3> rgb{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double k = std::fmod(5 - 2 * static_cast<double>(c) + hue, 6.0);  // HSV to RGB
    const double channel = value - value * saturation * std::clamp(std::min(k, 4 - k), 0.0, 1.0);
    rgb[c] = static_cast<std::uint8_t>(std::lround(255 * channel));
  }
  return rgb;
}

}  // namespace

Image8 paint_labels(const Segmentation& segmentation) {
  const Image<std::int32_t>& labels = segmentation.labels;
  Image8 picture(labels.width(), labels.height(), 3);
  std::vector<std::array<std::uint8_t, 3>> palette;
  for (const SegmentInfo& s : segmentation.segments) palette.push_back(color_of(s.label, s.chosen));
  for (int y = 0; y < labels.height(); ++y)
    for (int x = 0; x < labels.width(); ++x) {
      const auto& rgb = palette[static_cast<std::size_t>(labels.at(x, y))];
      std::copy(rgb.begin(), rgb.end(), &picture.at(x, y));
    }
  return picture;
}

}  // namespace drape::segmentation
