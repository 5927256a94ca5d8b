#include "segment_description.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace drape::segmentation {
namespace {

std::size_t at(std::int32_t label) {
  return static_cast<std::size_t>(label);
}

constexpr int most_sampled_side = 1024;

// A pixel well inside of each segment: the one farthest from other segments and the photo's border, of a
// lattice of pixels that is dense enough for a place to click on.
void find_inner_pixels(const Labels& labels, std::vector<SegmentInfo>& segments) {
  const int step = 1 + (std::max(labels.width(), labels.height()) - 1) / most_sampled_side;
  const int columns = 1 + (labels.width() - 1) / step;
  const int rows = 1 + (labels.height() - 1) / step;
  cv::Mat same(rows + 2, columns + 2, CV_8U, cv::Scalar(0));
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const std::int32_t label = labels.at(x * step, y * step);
      const bool left = x == 0 || labels.at((x - 1) * step, y * step) == label;
      const bool top = y == 0 || labels.at(x * step, (y - 1) * step) == label;
      same.at<std::uint8_t>(y + 1, x + 1) = left && top ? 1 : 0;
    }
  cv::Mat depth;
  cv::distanceTransform(same, depth, cv::DIST_L2, cv::DIST_MASK_3);
  std::vector<float> deepest(segments.size(), -1);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const std::size_t i = at(labels.at(x * step, y * step));
      if (depth.at<float>(y + 1, x + 1) <= deepest[i]) continue;
      deepest[i] = depth.at<float>(y + 1, x + 1);
      segments[i].inside_px = {x * step, y * step};
    }
}

}  // namespace

std::vector<SegmentInfo> segments_of(const Labels& labels, const Image8& rgb, const Image8& shape) {
  const auto count = at(1 + *std::max_element(labels.data().begin(), labels.data().end()));
  std::vector<SegmentInfo> segments(count);
  std::vector<std::array<double, 5>> sums(count, std::array<double, 5>{});  // r, g, b, pixels, object pixels
  for (int y = 0; y < labels.height(); ++y)
    for (int x = 0; x < labels.width(); ++x) {
      const std::size_t i = at(labels.at(x, y));
      SegmentInfo& s = segments[i];
      if (sums[i][3] == 0) {
        s.box_px = {x, y, x, y};  // corners for now
        s.inside_px = {x, y};     // for those that fall between the samples
      }
      s.box_px[0] = std::min(s.box_px[0], x);
      s.box_px[2] = std::max(s.box_px[2], x);
      s.box_px[3] = y;
      for (std::size_t c = 0; c < 3; ++c) sums[i][c] += rgb.at(x, y, static_cast<int>(c));
      sums[i][3] += 1;
      if (shape.at(x, y) == stencil::object) sums[i][4] += 1;
    }
  find_inner_pixels(labels, segments);
  for (std::size_t i = 0; i < count; ++i) {
    SegmentInfo& s = segments[i];
    s.label = static_cast<int>(i);
    s.area_percent = 100 * sums[i][3] / static_cast<double>(labels.data().size());
    s.box_px = {s.box_px[0], s.box_px[1], s.box_px[2] - s.box_px[0] + 1, s.box_px[3] - s.box_px[1] + 1};
    for (std::size_t c = 0; c < 3; ++c)
      s.mean_color[c] = static_cast<std::uint8_t>(std::lround(sums[i][c] / std::max(1.0, sums[i][3])));
    s.chosen = 2 * sums[i][4] > sums[i][3];
  }
  return segments;
}

}  // namespace drape::segmentation
