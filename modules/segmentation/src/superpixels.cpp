#include "superpixels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "region_graph.hpp"

namespace drape::segmentation {
namespace {

constexpr int iterations = 6;
constexpr float compactness = 12;  // Lab units that a distance of one patch width weighs

struct Center {
  std::array<float, 3> lab{};
  float x = 0;
  float y = 0;
};

std::vector<Center> seeded(const ImageF& lab, float step) {
  std::vector<Center> centers;
  const int columns = std::max(1, static_cast<int>(std::lround(static_cast<float>(lab.width()) / step)));
  const int rows = std::max(1, static_cast<int>(std::lround(static_cast<float>(lab.height()) / step)));
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const int x = (2 * c + 1) * lab.width() / (2 * columns);
      const int y = (2 * r + 1) * lab.height() / (2 * rows);
      centers.push_back({{lab.at(x, y, 0), lab.at(x, y, 1), lab.at(x, y, 2)},
                         static_cast<float>(x),
                         static_cast<float>(y)});
    }
  return centers;
}

void assign(const ImageF& lab, const std::vector<Center>& centers, float step, Labels& labels) {
  ImageF best(lab.width(), lab.height(), 1, std::numeric_limits<float>::max());
  const float weight = compactness * compactness / (step * step);
  for (std::size_t i = 0; i < centers.size(); ++i) {
    const Center& center = centers[i];
    const int left = std::max(0, static_cast<int>(center.x - step));
    const int right = std::min(lab.width() - 1, static_cast<int>(center.x + step));
    const int top = std::max(0, static_cast<int>(center.y - step));
    const int bottom = std::min(lab.height() - 1, static_cast<int>(center.y + step));
    for (int y = top; y <= bottom; ++y)
      for (int x = left; x <= right; ++x) {
        const float dx = static_cast<float>(x) - center.x;
        const float dy = static_cast<float>(y) - center.y;
        const float distance =
            squared_difference(&lab.at(x, y), center.lab.data()) + weight * (dx * dx + dy * dy);
        if (distance < best.at(x, y)) {
          best.at(x, y) = distance;
          labels.at(x, y) = static_cast<std::int32_t>(i);
        }
      }
  }
}

void move_to_means(const ImageF& lab, const Labels& labels, std::vector<Center>& centers) {
  std::vector<std::array<double, 6>> sums(centers.size(), std::array<double, 6>{});
  for (int y = 0; y < lab.height(); ++y)
    for (int x = 0; x < lab.width(); ++x) {
      auto& sum = sums[static_cast<std::size_t>(labels.at(x, y))];
      for (std::size_t c = 0; c < 3; ++c) sum[c] += lab.at(x, y, static_cast<int>(c));
      sum[3] += x;
      sum[4] += y;
      sum[5] += 1;
    }
  for (std::size_t i = 0; i < centers.size(); ++i) {
    if (sums[i][5] == 0) continue;
    for (std::size_t c = 0; c < 3; ++c) centers[i].lab[c] = static_cast<float>(sums[i][c] / sums[i][5]);
    centers[i].x = static_cast<float>(sums[i][3] / sums[i][5]);
    centers[i].y = static_cast<float>(sums[i][4] / sums[i][5]);
  }
}

}  // namespace

Labels superpixels(const ImageF& lab, int count) {
  const float step = std::max(1.F, std::sqrt(static_cast<float>(lab.width() * lab.height()) /
                                             static_cast<float>(std::max(1, count))));
  std::vector<Center> centers = seeded(lab, step);
  Labels labels(lab.width(), lab.height(), 1, 0);
  for (int i = 0; i < iterations; ++i) {
    assign(lab, centers, step, labels);
    move_to_means(lab, labels, centers);
  }
  return merged_regions(connected_regions(labels), lab, step * step / 4, 0);
}

}  // namespace drape::segmentation
