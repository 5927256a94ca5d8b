#include "cast_shadow.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

namespace drape::segmentation {
namespace {

constexpr double smoothing_px = 1;  // deviation of what is averaged before steps are measured
constexpr float most_step = 1.2F;   // Lab units a pixel: of noise and of a soft rim
constexpr int mixed_px = 2;         // beside a step, where the colours of both its sides mix

ImageF smoothed_lightness(const ImageF& lab) {
  ImageF lightness(lab.width(), lab.height(), 1);
  for (std::size_t i = 0; i < lightness.data().size(); ++i) lightness.data()[i] = lab.data()[3 * i];
  cv::Mat pixels(lightness.height(), lightness.width(), CV_32F, lightness.data().data());
  cv::GaussianBlur(pixels, pixels, {}, smoothing_px);
  return lightness;
}

// The `allowed` pixels that hang together with `from`, over steps up to `most` in `lightness`.
Image8 grown(const Image8& from, const Image8& allowed, const ImageF& lightness, float most) {
  Image8 reached(from.width(), from.height(), 1, 0);
  std::vector<std::pair<int, int>> open;
  for (int y = 0; y < from.height(); ++y)
    for (int x = 0; x < from.width(); ++x)
      if (from.at(x, y) != 0) open.emplace_back(x, y);
  while (!open.empty()) {
    const auto [x, y] = open.back();
    open.pop_back();
    for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const int u = x + dx;
      const int v = y + dy;
      if (!reached.contains(u, v) || reached.at(u, v) != 0 || from.at(u, v) != 0 || allowed.at(u, v) == 0)
        continue;
      if (std::abs(lightness.at(u, v) - lightness.at(x, y)) > most) continue;
      reached.at(u, v) = 1;
      open.emplace_back(u, v);
    }
  }
  return reached;
}

}  // namespace

Image8 cast_shadow(const ImageF& lab, const Image8& backdrop, const Image8& darker) {
  const ImageF lightness = smoothed_lightness(lab);
  Image8 shadow = grown(backdrop, darker, lightness, most_step);
  for (int ring = 0; ring < mixed_px; ++ring) {
    const Image8 before = shadow;
    for (int y = 0; y < shadow.height(); ++y)
      for (int x = 0; x < shadow.width(); ++x) {
        if (darker.at(x, y) == 0 || backdrop.at(x, y) != 0) continue;
        for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
          if (before.contains(x + dx, y + dy) && before.at(x + dx, y + dy) != 0) shadow.at(x, y) = 1;
      }
  }
  return shadow;
}

}  // namespace drape::segmentation
