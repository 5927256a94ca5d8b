#include "stencil_shape.hpp"

#include <algorithm>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace drape::segmentation {
namespace {

// Some pixels, by parts that hang together over their sides. Part 0 is all other pixels.
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

template <class IsIn>
Parts parts_of(const Image8& given, IsIn is_in) {
  cv::Mat state(given.height(), given.width(), CV_8U);
  for (int y = 0; y < given.height(); ++y)
    std::transform(given.row(y).begin(), given.row(y).end(), state.ptr(y),
                   [&](std::uint8_t v) { return static_cast<std::uint8_t>(is_in(v)); });
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
  const Parts p = parts_of(given, [](std::uint8_t v) { return v == stencil::object; });
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
  const Parts p = parts_of(given, [](std::uint8_t v) { return v != stencil::object; });
  const double object = p.pixels(0);
  std::vector<std::uint8_t> closed(static_cast<std::size_t>(p.count()), 0);
  for (int i = 1; i < p.count(); ++i)
    closed[static_cast<std::size_t>(i)] = !p.on_border(i) && p.pixels(i) <= most_share * object;
  Image8 out = given;
  paint(p, closed, stencil::object, out);
  return out;
}

Image8 with_unknown_beside(const Image8& shape, const Image8& states) {
  const auto& all = states.data();
  if (std::find(all.begin(), all.end(), stencil::unknown) == all.end()) return shape;
  const Parts p = parts_of(states, [](std::uint8_t v) { return v == stencil::unknown; });
  std::vector<std::uint8_t> beside(static_cast<std::size_t>(p.count()), 0);
  const auto look = [&](int x, int y, int u, int v) {
    if (shape.contains(u, v) && shape.at(u, v) == stencil::object)
      beside[static_cast<std::size_t>(p.labels.at<int>(y, x))] = 1;
  };
  for (int y = 0; y < shape.height(); ++y)
    for (int x = 0; x < shape.width(); ++x) {
      look(x, y, x - 1, y);
      look(x, y, x + 1, y);
      look(x, y, x, y - 1);
      look(x, y, x, y + 1);
    }
  Image8 out = shape;
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const int part = p.labels.at<int>(y, x);
      if (part > 0 && beside[static_cast<std::size_t>(part)] != 0 && out.at(x, y) != stencil::object)
        out.at(x, y) = stencil::unknown;
    }
  return out;
}

}  // namespace drape::segmentation
