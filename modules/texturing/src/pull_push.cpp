#include "pull_push.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "drape/base/parallel.hpp"
#include "linear_light.hpp"

namespace drape::texturing {
namespace {

constexpr std::size_t rows_per_chunk = 16;
constexpr int rings = 3;  // that grow pixel by pixel

template <class Body>
void for_rows(int height, Body body) {
  parallel_for(static_cast<std::size_t>(height), rows_per_chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) body(static_cast<int>(y));
  });
}

WeightedPixels pulled(const WeightedPixels& fine) {
  WeightedPixels coarse((fine.width + 1) / 2, (fine.height + 1) / 2);
  for_rows(coarse.height, [&](int row) {
    for (int y = 2 * row; y < std::min(2 * row + 2, fine.height); ++y)
      for (int x = 0; x < fine.width; ++x) coarse.at(x / 2, row) += fine.at(x, y);
    for (int x = 0; x < coarse.width; ++x) {
      Eigen::Vector4f& p = coarse.at(x, row);
      if (p.w() > 1) p /= p.w();
    }
  });
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
  for_rows(fine.height, [&](int y) {
    for (int x = 0; x < fine.width; ++x) {
      Eigen::Vector4f& p = fine.at(x, y);
      if (p.w() >= 1) continue;
      const Eigen::Vector4f behind = between(coarse, x, y);
      if (behind.w() > 0) p += (1 - p.w()) / behind.w() * behind;
    }
  });
}

struct Place {
  int x;
  int y;
};

template <class Visit>
void for_neighbors(const Place& p, const Image8& picture, Visit visit) {
  for (int y = std::max(0, p.y - 1); y <= std::min(picture.height() - 1, p.y + 1); ++y)
    for (int x = std::max(0, p.x - 1); x <= std::min(picture.width() - 1, p.x + 1); ++x)
      if (x != p.x || y != p.y) visit(x, y, x == p.x || y == p.y ? 2.F : 1.F);
}

std::vector<Place> unknown_beside_known(const Image8& known) {
  std::vector<Place> rim;
  for (int y = 0; y < known.height(); ++y)
    for (int x = 0; x < known.width(); ++x) {
      if (known.at(x, y) != 0) continue;
      bool beside = false;
      for_neighbors({x, y}, known, [&](int u, int v, float) { beside = beside || known.at(u, v) != 0; });
      if (beside) rim.push_back({x, y});
    }
  return rim;
}

// Pixel by pixel outwards, each the mean of its known neighbours: next to what is known, narrow stripes go on
// as narrow as they are, where coarser means would mix them.
template <class Sample>
void grow_rings(Image<Sample>& rgb, Image8& known) {
  std::vector<Place> ring = unknown_beside_known(known);
  std::vector<std::array<Sample, 3>> colors;
  for (int i = 0; i < rings && !ring.empty(); ++i) {
    colors.clear();
    for (const Place& p : ring) {
      Eigen::Vector4f sum = Eigen::Vector4f::Zero();
      for_neighbors(p, known, [&](int x, int y, float weight) {
        if (known.at(x, y) == 0) return;
        sum += weight * Eigen::Vector4f(linear_from(rgb.at(x, y, 0)), linear_from(rgb.at(x, y, 1)),
                                        linear_from(rgb.at(x, y, 2)), 1);
      });
      sum /= sum.w();
      colors.push_back({stored_as<Sample>(sum[0]), stored_as<Sample>(sum[1]), stored_as<Sample>(sum[2])});
    }
    for (std::size_t k = 0; k < ring.size(); ++k) {
      known.at(ring[k].x, ring[k].y) = 1;
      for (int c = 0; c < 3; ++c) rgb.at(ring[k].x, ring[k].y, c) = colors[k][static_cast<std::size_t>(c)];
    }
    std::vector<Place> next;
    constexpr std::uint8_t listed = 2;
    for (const Place& p : ring)
      for_neighbors(p, known, [&](int x, int y, float) {
        if (known.at(x, y) != 0) return;
        known.at(x, y) = listed;
        next.push_back({x, y});
      });
    for (const Place& p : next) known.at(p.x, p.y) = 0;
    ring = std::move(next);
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

template <class Sample>
void grow_colors(Image<Sample>& rgb, const Image8& given) {
  const auto unknown = [](std::uint8_t v) { return v == 0; };
  const auto begin = given.data().begin();
  const auto end = given.data().end();
  if (std::none_of(begin, end, unknown) || std::all_of(begin, end, unknown)) return;
  Image8 known = given;
  grow_rings(rgb, known);
  // The finest level, of four floats a pixel, is never there as a whole.
  WeightedPixels coarse((rgb.width() + 1) / 2, (rgb.height() + 1) / 2);
  for_rows(coarse.height, [&](int row) {
    for (int y = 2 * row; y < std::min(2 * row + 2, rgb.height()); ++y)
      for (int x = 0; x < rgb.width(); ++x)
        if (known.at(x, y) != 0)
          coarse.at(x / 2, row) += Eigen::Vector4f(linear_from(rgb.at(x, y, 0)), linear_from(rgb.at(x, y, 1)),
                                                   linear_from(rgb.at(x, y, 2)), 1);
    for (int x = 0; x < coarse.width; ++x) {
      Eigen::Vector4f& p = coarse.at(x, row);
      if (p.w() > 1) p /= p.w();
    }
  });
  coarse = pull_pushed(std::move(coarse));
  for_rows(rgb.height(), [&](int y) {
    for (int x = 0; x < rgb.width(); ++x) {
      if (known.at(x, y) != 0) continue;
      const Eigen::Vector4f behind = between(coarse, x, y);
      for (int c = 0; c < 3; ++c) rgb.at(x, y, c) = stored_as<Sample>(behind[c] / behind.w());
    }
  });
}

template void grow_colors(Image8& rgb, const Image8& known);
template void grow_colors(Image16& rgb, const Image8& known);

}  // namespace drape::texturing
