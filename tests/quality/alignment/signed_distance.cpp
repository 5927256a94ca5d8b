#include "signed_distance.hpp"

#include <opencv2/imgproc.hpp>

namespace drape::lab {

ImageF signed_distance(const Image8& stencil) {
  cv::Mat inside(stencil.height(), stencil.width(), CV_8U);
  for (int y = 0; y < inside.rows; ++y)
    for (int x = 0; x < inside.cols; ++x)
      inside.at<std::uint8_t>(y, x) = stencil.at(x, y) == stencil::object ? 255 : 0;
  cv::Mat to_background;
  cv::Mat to_object;
  cv::distanceTransform(inside, to_background, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::distanceTransform(255 - inside, to_object, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  ImageF distance(stencil.width(), stencil.height(), 1);
  for (int y = 0; y < inside.rows; ++y)
    for (int x = 0; x < inside.cols; ++x)
      distance.at(x, y) = inside.at<std::uint8_t>(y, x) > 0 ? to_background.at<float>(y, x) - 0.5F
                                                            : 0.5F - to_object.at<float>(y, x);
  return distance;
}

}  // namespace drape::lab
