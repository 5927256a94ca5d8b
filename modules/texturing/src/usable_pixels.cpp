#include "usable_pixels.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace drape::texturing {
namespace {

// Distance of each pixel's centre to the nearest centre of a pixel where `on` is 0. Very large without any.
cv::Mat distance_to_zero(const cv::Mat& on) {
  cv::Mat distance;
  cv::distanceTransform(on, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  if (cv::countNonZero(on) == static_cast<int>(on.total())) distance.setTo(1e9);
  return distance;
}

}  // namespace

Image8 usable_pixels(const Image8& stencil_or_empty, int width, int height, double erode_px, double fill_px) {
  Image8 trusted(width, height, 1, trust::full);
  if (stencil_or_empty.empty()) return trusted;
  const cv::Mat given(height, width, CV_8U, const_cast<std::uint8_t*>(stencil_or_empty.data().data()));
  // An outline runs half a pixel from the centres on either side of it.
  const cv::Mat inside = distance_to_zero(given == stencil::object) >= erode_px + 0.5;
  const cv::Mat outside = distance_to_zero(inside == 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (inside.at<std::uint8_t>(y, x) != 0) continue;
      trusted.at(x, y) = outside.at<float>(y, x) <= fill_px ? trust::near : trust::none;
    }
  return trusted;
}

}  // namespace drape::texturing
