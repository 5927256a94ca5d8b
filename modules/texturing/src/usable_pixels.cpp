#include "usable_pixels.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace drape::texturing {
namespace {

constexpr double most_stamped_px = 24;

// Distance of each pixel's centre to the nearest centre of a pixel where `on` is 0. Very large without any.
cv::Mat distance_to_zero(const cv::Mat& on) {
  cv::Mat distance;
  cv::distanceTransform(on, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  if (cv::countNonZero(on) == static_cast<int>(on.total())) distance.setTo(1e9);
  return distance;
}

// A row of the pixels round a pixel: offset down, and how far to either side.
struct DiscRow {
  int down;
  int half_width;
};

// The centres within a distance of one, or nearer than it.
std::vector<DiscRow> disc(double radius_px, bool and_at) {
  std::vector<DiscRow> rows;
  const auto holds = [&](int x, int y) {
    const double square = static_cast<double>(x) * x + static_cast<double>(y) * y;
    return and_at ? square <= radius_px * radius_px : square < radius_px * radius_px;
  };
  const int reach = static_cast<int>(std::ceil(radius_px));
  for (int y = -reach; y <= reach; ++y) {
    int x = -1;
    while (holds(x + 1, y)) ++x;
    if (x >= 0) rows.push_back({y, x});
  }
  return rows;
}

// Pixels that are set, of 0 and 255, where a neighbour on a side is not.
template <class Visit>
void for_rim(const cv::Mat& on, Visit visit) {
  for (int y = 0; y < on.rows; ++y) {
    const auto* row = on.ptr<std::uint8_t>(y);
    const auto* above = on.ptr<std::uint8_t>(std::max(0, y - 1));
    const auto* below = on.ptr<std::uint8_t>(std::min(on.rows - 1, y + 1));
    for (int x = 0; x < on.cols; ++x)
      if (row[x] != 0 && (row[std::max(0, x - 1)] == 0 || row[std::min(on.cols - 1, x + 1)] == 0 ||
                          above[x] == 0 || below[x] == 0))
        visit(x, y);
  }
}

// Pixels within `radius_px` of one that is set, or nearer: what lies on the way to the nearest one is not
// set, so that one is on the rim, and a disc round each of those reaches all.
cv::Mat grown(const cv::Mat& on, double radius_px, bool and_at) {
  if (radius_px > most_stamped_px) {
    const cv::Mat distance = distance_to_zero(on == 0);
    return and_at ? distance <= radius_px : distance < radius_px;
  }
  cv::Mat result = on.clone();
  const std::vector<DiscRow> rows = disc(radius_px, and_at);
  for_rim(on, [&](int x, int y) {
    for (const DiscRow& r : rows) {
      if (y + r.down < 0 || y + r.down >= on.rows) continue;
      const int left = std::max(0, x - r.half_width);
      const int right = std::min(on.cols - 1, x + r.half_width);
      std::fill_n(result.ptr<std::uint8_t>(y + r.down) + left, right - left + 1, std::uint8_t{255});
    }
  });
  return result;
}

}  // namespace

Image8 usable_pixels(const Image8& stencil_or_empty, int width, int height, double erode_px, double fill_px) {
  Image8 trusted(width, height, 1, trust::full);
  if (stencil_or_empty.empty()) return trusted;
  const cv::Mat given(height, width, CV_8U, const_cast<std::uint8_t*>(stencil_or_empty.data().data()));
  // An outline runs half a pixel from the centres on either side of it.
  const cv::Mat inside = grown(given != stencil::object, erode_px + 0.5, false) == 0;
  const cv::Mat reached = grown(inside, fill_px, true);
  for (int y = 0; y < height; ++y) {
    const auto* full = inside.ptr<std::uint8_t>(y);
    const auto* near = reached.ptr<std::uint8_t>(y);
    for (int x = 0; x < width; ++x)
      if (full[x] == 0) trusted.at(x, y) = near[x] != 0 ? trust::near : trust::none;
  }
  return trusted;
}

}  // namespace drape::texturing
