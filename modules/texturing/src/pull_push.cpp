#include "pull_push.hpp"

#include <algorithm>
#include <utility>

namespace drape::texturing {
namespace {

WeightedPixels pulled(const WeightedPixels& fine) {
  WeightedPixels coarse((fine.width + 1) / 2, (fine.height + 1) / 2);
  for (int y = 0; y < fine.height; ++y)
    for (int x = 0; x < fine.width; ++x) coarse.at(x / 2, y / 2) += fine.at(x, y);
  for (Eigen::Vector4f& p : coarse.pixels)
    if (p.w() > 1) p /= p.w();
  return coarse;
}

// Bilinear between the centres of coarse pixels.
Eigen::Vector4f between(const WeightedPixels& coarse, int x, int y) {
  const auto sides = [](int i, int size) {
    const int near = std::min(i / 2, size - 1);
    const int far = std::clamp(i % 2 == 0 ? near - 1 : near + 1, 0, size - 1);
    return std::pair{near, far};
  };
  const auto [nx, fx] = sides(x, coarse.width);
  const auto [ny, fy] = sides(y, coarse.height);
  return 0.5625F * coarse.at(nx, ny) + 0.1875F * (coarse.at(fx, ny) + coarse.at(nx, fy)) +
         0.0625F * coarse.at(fx, fy);
}

void push(const WeightedPixels& coarse, WeightedPixels& fine) {
  for (int y = 0; y < fine.height; ++y)
    for (int x = 0; x < fine.width; ++x) {
      Eigen::Vector4f& p = fine.at(x, y);
      if (p.w() >= 1) continue;
      const Eigen::Vector4f behind = between(coarse, x, y);
      if (behind.w() > 0) p += (1 - p.w()) / behind.w() * behind;
    }
}

}  // namespace

WeightedPixels pull_pushed(WeightedPixels pixels) {
  std::vector<WeightedPixels> levels;
  levels.push_back(std::move(pixels));
  while (levels.back().width > 1 || levels.back().height > 1) levels.push_back(pulled(levels.back()));
  Eigen::Vector4f& mean = levels.back().pixels[0];
  if (mean.w() > 0) mean /= mean.w();
  for (std::size_t i = levels.size() - 1; i > 0; --i) push(levels[i], levels[i - 1]);
  return std::move(levels[0]);
}

}  // namespace drape::texturing
