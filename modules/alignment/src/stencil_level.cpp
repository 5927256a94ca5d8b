#include "stencil_level.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace drape::alignment {
namespace {

constexpr double margin = 0.4;  // of the object's size, on each side
constexpr int margin_px = 6;    // of the window, at least

struct PixelBox {
  int left = 0, top = 0, right = -1, bottom = -1;  // inclusive
  [[nodiscard]] int extent() const { return std::max(right - left, bottom - top) + 1; }
};

PixelBox object_box(const Image8& stencil) {
  PixelBox box{stencil.width(), stencil.height(), -1, -1};
  for (int y = 0; y < stencil.height(); ++y) {
    const auto row = stencil.row(y);
    const auto first = std::find(row.begin(), row.end(), stencil::object);
    if (first == row.end()) continue;
    const auto last = std::find(row.rbegin(), row.rend(), stencil::object);
    box.left = std::min(box.left, static_cast<int>(first - row.begin()));
    box.right = std::max(box.right, static_cast<int>(row.rend() - last) - 1);
    box.top = std::min(box.top, y);
    box.bottom = y;
  }
  return box;
}

// The photo's pixels in blocks of step x step, with their corner at (left, top).
struct Blocks {
  int left = 0, top = 0, step = 1;
  Image8 coverage;  // by the object, of what is known: 0..255
  Image8 known;     // 1: at least half of the block is
};

Blocks blocks_of(const Image8& stencil, int step) {
  const PixelBox box = object_box(stencil);
  const int around = std::max(margin_px * step, static_cast<int>(margin * box.extent()));
  Blocks blocks;
  blocks.step = step;
  blocks.left = box.left - around;
  blocks.top = box.top - around;
  const int width = (box.right + 1 + around - blocks.left + step - 1) / step;
  const int height = (box.bottom + 1 + around - blocks.top + step - 1) / step;
  blocks.coverage = Image8(width, height, 1, 0);
  blocks.known = Image8(width, height, 1, 0);
  for (int by = 0; by < height; ++by)
    for (int bx = 0; bx < width; ++bx) {
      const int x0 = std::max(0, blocks.left + bx * step);
      const int y0 = std::max(0, blocks.top + by * step);
      const int x1 = std::min(stencil.width(), blocks.left + (bx + 1) * step);
      const int y1 = std::min(stencil.height(), blocks.top + (by + 1) * step);
      int object = 0;
      int known = 0;
      for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
          const std::uint8_t value = stencil.at(x, y);
          object += value == stencil::object ? 1 : 0;
          known += value != stencil::unknown ? 1 : 0;
        }
      if (2 * known < step * step || known == 0) continue;
      blocks.known.at(bx, by) = 1;
      blocks.coverage.at(bx, by) = static_cast<std::uint8_t>((255 * object + known / 2) / known);
    }
  return blocks;
}

// Direction in which coverage falls, by a Gaussian's derivative about `at` (block coordinates).
Eigen::Vector2d falling(const Blocks& blocks, const Eigen::Vector2d& at) {
  constexpr int reach = 3;
  constexpr double sigma = 1.7;
  const int cx = static_cast<int>(std::floor(at.x()));
  const int cy = static_cast<int>(std::floor(at.y()));
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  for (int y = std::max(0, cy - reach); y <= std::min(blocks.coverage.height() - 1, cy + reach); ++y)
    for (int x = std::max(0, cx - reach); x <= std::min(blocks.coverage.width() - 1, cx + reach); ++x) {
      if (blocks.known.at(x, y) == 0) continue;
      const Eigen::Vector2d offset(x + 0.5 - at.x(), y + 0.5 - at.y());
      const double weight = std::exp(-offset.squaredNorm() / (2 * sigma * sigma));
      gradient -= weight * (blocks.coverage.at(x, y) - 127.5) * offset;
    }
  return gradient.norm() > 1e-9 ? Eigen::Vector2d(gradient.normalized()) : Eigen::Vector2d(1, 0);
}

// In block coordinates.
std::vector<ContourPoint> contour_of(const Blocks& blocks) {
  std::vector<ContourPoint> contour;
  const auto add = [&](int x, int y, int dx, int dy) {
    if (!blocks.coverage.contains(x + dx, y + dy)) return;
    const int here = blocks.coverage.at(x, y);
    const int there = blocks.coverage.at(x + dx, y + dy);
    if ((here > 127) == (there > 127)) return;
    if (blocks.known.at(x, y) == 0 || blocks.known.at(x + dx, y + dy) == 0) return;
    const double t = (here - 127.5) / (here - there);
    ContourPoint point;
    point.at = Eigen::Vector2d(x + 0.5 + t * dx, y + 0.5 + t * dy);
    point.outward = falling(blocks, point.at);
    // An outline of normal (nx, ny) crosses |nx| rows' and |ny| columns' lattice lines per unit of length.
    point.length = dx != 0 ? std::abs(point.outward.x()) : std::abs(point.outward.y());
    contour.push_back(point);
  };
  for (int y = 0; y < blocks.coverage.height(); ++y)
    for (int x = 0; x < blocks.coverage.width(); ++x) {
      add(x, y, 1, 0);
      add(x, y, 0, 1);
    }
  return contour;
}

void fill_window(const Blocks& blocks, StencilLevel& level) {
  for (int y = 0; y < level.window.height; ++y)
    for (int x = 0; x < level.window.width; ++x) {
      if (blocks.known.at(x, y) == 0) continue;
      level.known.set(x, y);
      if (blocks.coverage.at(x, y) > 127) level.object.set(x, y);
    }
}

// For a lens with distortion: the window is in ideal pixels, and samples the blocks.
void fill_window(const Blocks& blocks, const PhotoPlane& plane, StencilLevel& level) {
  for (int y = 0; y < level.window.height; ++y)
    for (int x = 0; x < level.window.width; ++x) {
      const Eigen::Vector2d photo = plane.to_photo(level.window.to_photo(Eigen::Vector2d(x + 0.5, y + 0.5)));
      const int bx = static_cast<int>(std::floor((photo.x() - blocks.left) / blocks.step));
      const int by = static_cast<int>(std::floor((photo.y() - blocks.top) / blocks.step));
      if (!blocks.known.contains(bx, by) || blocks.known.at(bx, by) == 0) continue;
      level.known.set(x, y);
      if (blocks.coverage.at(bx, by) > 127) level.object.set(x, y);
    }
}

Image<std::int32_t> nearest_points(const StencilLevel& level, double reach_px) {
  Image<std::int32_t> nearest(level.window.width, level.window.height, 1, StencilLevel::none);
  const int reach = static_cast<int>(std::ceil(reach_px));
  for (std::size_t i = 0; i < level.contour.size(); ++i) {
    const Eigen::Vector2d& at = level.contour[i].at;
    const int cx = static_cast<int>(std::floor(at.x()));
    const int cy = static_cast<int>(std::floor(at.y()));
    for (int y = std::max(0, cy - reach); y <= std::min(nearest.height() - 1, cy + reach); ++y)
      for (int x = std::max(0, cx - reach); x <= std::min(nearest.width() - 1, cx + reach); ++x) {
        const Eigen::Vector2d center(x + 0.5, y + 0.5);
        const double squared = (at - center).squaredNorm();
        if (squared > reach_px * reach_px) continue;
        std::int32_t& best = nearest.at(x, y);
        if (best == StencilLevel::none ||
            squared < (level.contour[static_cast<std::size_t>(best)].at - center).squaredNorm())
          best = static_cast<std::int32_t>(i);
      }
  }
  return nearest;
}

}  // namespace

int object_extent(const Image8& stencil) {
  return object_box(stencil).extent();
}

StencilLevel stencil_level(const Image8& stencil, const PhotoPlane& plane, int step, double reach_px) {
  const Blocks blocks = blocks_of(stencil, step);
  StencilLevel level;
  level.window.px_per_photo_px = 1.0 / step;
  level.window.width = blocks.coverage.width();
  level.window.height = blocks.coverage.height();
  level.window.origin = plane.to_ideal(Eigen::Vector2d(blocks.left, blocks.top));
  level.contour = contour_of(blocks);
  const auto to_window = [&](const Eigen::Vector2d& block) {
    return level.window.from_photo(
        plane.to_ideal(Eigen::Vector2d(blocks.left, blocks.top) + block * static_cast<double>(step)));
  };
  if (!plane.plain()) {
    // Distortion moves the corners apart: the window is laid about the outline anew.
    const Eigen::Vector2d middle = Eigen::Vector2d(level.window.width, level.window.height) / 2;
    const Eigen::Vector2d shift = to_window(middle) - middle;
    level.window.origin += shift * static_cast<double>(step);
  }
  for (ContourPoint& point : level.contour) {
    if (!plane.plain()) {
      const Eigen::Vector2d ahead = to_window(point.at + point.outward);
      point.at = to_window(point.at);
      point.outward = (ahead - point.at).normalized();
    }
    level.contour_length += point.length;
  }
  level.object = BitImage(level.window.width, level.window.height);
  level.known = BitImage(level.window.width, level.window.height);
  if (plane.plain())
    fill_window(blocks, level);
  else
    fill_window(blocks, plane, level);
  level.nearest = nearest_points(level, reach_px);
  return level;
}

}  // namespace drape::alignment
