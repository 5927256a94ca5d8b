#include "grabcut.hpp"

#include <algorithm>
#include <cstdlib>
#include <opencv2/imgproc.hpp>

namespace drape::segmentation {
namespace {

constexpr int iterations = 5;
constexpr int click_radius = 2;
constexpr double inset = 0.06;  // of the picture, a side

}  // namespace

Image8 grabcut(const Image8& rgb, const Image8& guess, const Hints& hints, std::uint64_t seed) {
  cv::Mat mask(guess.height(), guess.width(), CV_8U);
  int objects = 0;
  int others = 0;
  for (int y = 0; y < guess.height(); ++y)
    for (int x = 0; x < guess.width(); ++x) {
      std::uint8_t value = guess.at(x, y) == stencil::object ? cv::GC_PR_FGD : cv::GC_PR_BGD;
      if (hints.box) {
        const auto& [left, top, right, bottom] = *hints.box;
        if (x < left || y < top || x >= right || y >= bottom) value = cv::GC_BGD;
      }
      if (hints.click && std::abs(x - (*hints.click)[0]) <= click_radius &&
          std::abs(y - (*hints.click)[1]) <= click_radius)
        value = cv::GC_FGD;
      if (!hints.scribbles.empty() && hints.scribbles.at(x, y) != stencil::unknown)
        value = hints.scribbles.at(x, y) == stencil::object ? cv::GC_FGD : cv::GC_BGD;
      mask.at<std::uint8_t>(y, x) = value;
      ++(value == cv::GC_PR_FGD || value == cv::GC_FGD ? objects : others);
    }
  // Its mixtures of five colours need some pixels of each kind.
  if (std::min(objects, others) < 10) return guess;
  // OpenCV counts channels as B, G, R but treats all three alike.
  const cv::Mat picture(rgb.height(), rgb.width(), CV_8UC3, const_cast<std::uint8_t*>(rgb.data().data()));
  cv::Mat background_model;
  cv::Mat object_model;
  cv::theRNG().state = seed | 1U;
  cv::grabCut(picture, mask, cv::Rect(), background_model, object_model, iterations, cv::GC_INIT_WITH_MASK);
  Image8 out(guess.width(), guess.height(), 1, stencil::background);
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x)
      if ((mask.at<std::uint8_t>(y, x) & 1U) != 0) out.at(x, y) = stencil::object;  // GC_FGD 1, GC_PR_FGD 3
  return out;
}

std::array<int, 4> inset_box(int width, int height) {
  const int x = static_cast<int>(inset * width);
  const int y = static_cast<int>(inset * height);
  return {x, y, width - x, height - y};
}

Image8 elliptic_guess(int width, int height, const std::array<int, 4>& box) {
  Image8 guess(width, height, 1, stencil::background);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double u = (2 * (x + 0.5) - box[0] - box[2]) / (box[2] - box[0]);
      const double v = (2 * (y + 0.5) - box[1] - box[3]) / (box[3] - box[1]);
      if (u * u + v * v < 1) guess.at(x, y) = stencil::object;
    }
  return guess;
}

}  // namespace drape::segmentation
