#include "stencil_shape.hpp"

#include <algorithm>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace drape::segmentation {
namespace {

// The pixels of one state, by parts that hang together over their sides. Part 0 is all other pixels.
struct Parts {
  cv::Mat labels;
  cv::Mat stats;

  [[nodiscard]] int count() const { return stats.rows; }
  [[nodiscard]] double pixels(int part) const { return stats.at<int>(part, cv::CC_STAT_AREA); }
  [[nodiscard]] bool on_border(int part) const {
    const int left = stats.at<int>(part, cv::CC_STAT_LEFT);
    const int top = stats.at<int>(part, cv::CC_STAT_TOP);
    return left == 0 || top == 0 || left + stats.at<int>(part, cv::CC_STAT_WIDTH) == labels.cols ||
           top + stats.at<int>(part, cv::CC_STAT_HEIGHT) == labels.rows;
  }
};

Parts parts_of(const Image8& given, bool object) {
  cv::Mat state(given.height(), given.width(), CV_8U);
  for (int y = 0; y < given.height(); ++y)
    std::transform(given.row(y).begin(), given.row(y).end(), state.ptr(y), [&](std::uint8_t v) {
      return static_cast<std::uint8_t>((v == stencil::object) == object);
    });
  Parts p;
  cv::Mat centers;
  cv::connectedComponentsWithStats(state, p.labels, p.stats, centers, 4, CV_32S);
  return p;
}

// Writes `value` to the pixels of the parts marked.
void paint(const Parts& p, const std::vector<std::uint8_t>& marked, std::uint8_t value, Image8& out) {
  for (int y = 0; y < out.height(); ++y) {
    const int* label = p.labels.ptr<int>(y);
    for (std::uint8_t& pixel : out.row(y))
      if (marked[static_cast<std::size_t>(*label++)]) pixel = value;
  }
}

}  // namespace

Image8 without_islands(const Image8& given, double least_share, std::optional<std::array<int, 2>> must_hold) {
  const Parts p = parts_of(given, true);
  const int only = must_hold ? p.labels.at<int>((*must_hold)[1], (*must_hold)[0]) : 0;
  double main = 0;
  for (int i = 1; i < p.count(); ++i) main = std::max(main, p.pixels(i));
  std::vector<std::uint8_t> kept(static_cast<std::size_t>(p.count()), 0);
  for (int i = 1; i < p.count(); ++i)
    kept[static_cast<std::size_t>(i)] = only > 0 ? i == only : p.pixels(i) >= least_share * main;
  Image8 out(given.width(), given.height(), 1, stencil::background);
  paint(p, kept, stencil::object, out);
  return out;
}

Image8 without_holes(const Image8& given, double most_share) {
  const Parts p = parts_of(given, false);
  const double object = p.pixels(0);
  std::vector<std::uint8_t> closed(static_cast<std::size_t>(p.count()), 0);
  for (int i = 1; i < p.count(); ++i)
    closed[static_cast<std::size_t>(i)] = !p.on_border(i) && p.pixels(i) <= most_share * object;
  Image8 out = given;
  paint(p, closed, stencil::object, out);
  return out;
}

}  // namespace drape::segmentation
