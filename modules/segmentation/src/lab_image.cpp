#include "lab_image.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace drape::segmentation {

ImageF lab_image(const Image8& rgb) {
  ImageF lab(rgb.width(), rgb.height(), 3);
  // OpenCV wants a mutable pointer to look at pixels it does not write.
  const cv::Mat bytes(rgb.height(), rgb.width(), CV_8UC3, const_cast<std::uint8_t*>(rgb.data().data()));
  cv::Mat out(lab.height(), lab.width(), CV_32FC3, lab.data().data());
  cv::Mat unit;
  bytes.convertTo(unit, CV_32FC3, 1.0 / 255.0);
  cv::cvtColor(unit, out, cv::COLOR_RGB2Lab);
  return lab;
}

Image8 reduced(const Image8& rgb, int max_side) {
  const int side = std::max(rgb.width(), rgb.height());
  if (side <= max_side) return rgb;
  const double factor = static_cast<double>(max_side) / side;
  const int width = std::max(1, static_cast<int>(std::lround(rgb.width() * factor)));
  const int height = std::max(1, static_cast<int>(std::lround(rgb.height() * factor)));
  Image8 small(width, height, 3);
  const cv::Mat from(rgb.height(), rgb.width(), CV_8UC3, const_cast<std::uint8_t*>(rgb.data().data()));
  cv::Mat to(height, width, CV_8UC3, small.data().data());
  cv::resize(from, to, to.size(), 0, 0, cv::INTER_AREA);
  return small;
}

}  // namespace drape::segmentation
