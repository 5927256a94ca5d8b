#include "distance_field.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace drape::texturing {

DistanceField::DistanceField(const Image8& stencil, int step)
    : values_((stencil.width() + step - 1) / step, (stencil.height() + step - 1) / step, 1), step_(step) {
  cv::Mat inside(values_.height(), values_.width(), CV_8U);
  for (int y = 0; y < inside.rows; ++y)
    for (int x = 0; x < inside.cols; ++x)
      inside.at<std::uint8_t>(y, x) = stencil.at(x * step, y * step) == stencil::object ? 255 : 0;
  cv::Mat within;
  cv::Mat beyond;
  // Near the outline, where it matters, the mask of 5 x 5 is exact to a few hundredths of a pixel.
  cv::distanceTransform(inside, within, cv::DIST_L2, cv::DIST_MASK_5);
  cv::distanceTransform(255 - inside, beyond, cv::DIST_L2, cv::DIST_MASK_5);
  cv::Mat distance(inside.rows, inside.cols, CV_32F, values_.data().data());
  distance = within - beyond;
  cv::GaussianBlur(distance, distance, {5, 5}, 1.0);
  distance *= static_cast<double>(step);
}

double DistanceField::at(const Eigen::Vector2d& pixel) const {
  const double px = std::clamp((pixel.x() - 0.5) / step_, 0.0, values_.width() - 1.0);
  const double py = std::clamp((pixel.y() - 0.5) / step_, 0.0, values_.height() - 1.0);
  const int x = static_cast<int>(px);
  const int y = static_cast<int>(py);
  const double fx = px - x;
  const double fy = py - y;
  const int right = std::min(x + 1, values_.width() - 1);
  const int below = std::min(y + 1, values_.height() - 1);
  return (1 - fy) * ((1 - fx) * values_.at(x, y) + fx * values_.at(right, y)) +
         fy * ((1 - fx) * values_.at(x, below) + fx * values_.at(right, below));
}

Eigen::Vector2d DistanceField::slope_at(const Eigen::Vector2d& pixel) const {
  const double h = 1.5 * step_;
  const Eigen::Vector2d dx(h, 0);
  const Eigen::Vector2d dy(0, h);
  return Eigen::Vector2d(at(pixel + dx) - at(pixel - dx), at(pixel + dy) - at(pixel - dy)) / (2 * h);
}

}  // namespace drape::texturing
