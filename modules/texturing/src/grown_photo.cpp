#include "grown_photo.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "linear_light.hpp"
#include "usable_pixels.hpp"

namespace drape::texturing {
namespace {

// Linear colours times their weight, and the weight.
struct Level {
  int width = 0;
  int height = 0;
  std::vector<Eigen::Vector4f> pixels;

  Level(int w, int h)
      : width(w),
        height(h),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), Eigen::Vector4f::Zero()) {}
  Eigen::Vector4f& at(int x, int y) { return pixels[index(x, y)]; }
  [[nodiscard]] const Eigen::Vector4f& at(int x, int y) const { return pixels[index(x, y)]; }
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

Level pulled(const Level& fine) {
  Level coarse((fine.width + 1) / 2, (fine.height + 1) / 2);
  for (int y = 0; y < fine.height; ++y)
    for (int x = 0; x < fine.width; ++x) coarse.at(x / 2, y / 2) += fine.at(x, y);
  for (Eigen::Vector4f& p : coarse.pixels)
    if (p.w() > 1) p /= p.w();
  return coarse;
}

// Bilinear between the centres of coarse pixels.
Eigen::Vector4f between(const Level& coarse, int x, int y) {
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

void push(const Level& coarse, Level& fine) {
  for (int y = 0; y < fine.height; ++y)
    for (int x = 0; x < fine.width; ++x) {
      Eigen::Vector4f& p = fine.at(x, y);
      if (p.w() >= 1) continue;
      const Eigen::Vector4f behind = between(coarse, x, y);
      if (behind.w() > 0) p += (1 - p.w()) / behind.w() * behind;
    }
}

}  // namespace

Image8 grown_photo(const Image8& rgb, const Image8& trusted, const PixelBox& box) {
  Image8 grown(box.width(), box.height(), 3);
  std::vector<Level> levels;
  levels.emplace_back(box.width(), box.height());
  bool complete = true;
  for (int y = 0; y < box.height(); ++y) {
    std::copy_n(&rgb.at(box.left, box.top + y), 3 * box.width(), grown.row(y).begin());
    for (int x = 0; x < box.width(); ++x) {
      if (trusted.at(box.left + x, box.top + y) != trust::full) {
        complete = false;
        continue;
      }
      Eigen::Vector4f& p = levels[0].at(x, y);
      for (int c = 0; c < 3; ++c) p[c] = linear_from_byte(grown.at(x, y, c));
      p.w() = 1;
    }
  }
  if (complete) return grown;
  while (levels.back().width > 1 || levels.back().height > 1) levels.push_back(pulled(levels.back()));
  if (levels.back().pixels[0].w() == 0) return grown;
  levels.back().pixels[0] /= levels.back().pixels[0].w();
  for (std::size_t i = levels.size() - 1; i > 0; --i) push(levels[i], levels[i - 1]);
  for (int y = 0; y < box.height(); ++y)
    for (int x = 0; x < box.width(); ++x) {
      if (trusted.at(box.left + x, box.top + y) == trust::full) continue;
      for (int c = 0; c < 3; ++c) grown.at(x, y, c) = byte_from_linear(levels[0].at(x, y)[c]);
    }
  return grown;
}

}  // namespace drape::texturing
