#include "object_box.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace drape::alignment {

std::optional<std::array<double, 4>> object_box(const Image8& stencil) {
  constexpr double room = 0.1;  // of the box's sides, on each
  cv::Mat object(stencil.height(), stencil.width(), CV_8U);
  std::transform(stencil.data().begin(), stencil.data().end(), object.data,
                 [](std::uint8_t v) { return static_cast<std::uint8_t>(v == stencil::object); });
  cv::Mat labels;
  cv::Mat statistics;
  cv::Mat middles;
  const int count = cv::connectedComponentsWithStats(object, labels, statistics, middles);
  int largest = 0;  // the background
  for (int i = 1; i < count; ++i)
    if (largest == 0 ||
        statistics.at<int>(i, cv::CC_STAT_AREA) > statistics.at<int>(largest, cv::CC_STAT_AREA))
      largest = i;
  if (largest == 0) return std::nullopt;
  const double x = statistics.at<int>(largest, cv::CC_STAT_LEFT);
  const double y = statistics.at<int>(largest, cv::CC_STAT_TOP);
  const double width = statistics.at<int>(largest, cv::CC_STAT_WIDTH);
  const double height = statistics.at<int>(largest, cv::CC_STAT_HEIGHT);
  const double left = std::max(0.0, x - room * width);
  const double top = std::max(0.0, y - room * height);
  return std::array{left, top, std::min<double>(stencil.width(), x + (1 + room) * width) - left,
                    std::min<double>(stencil.height(), y + (1 + room) * height) - top};
}

}  // namespace drape::alignment
