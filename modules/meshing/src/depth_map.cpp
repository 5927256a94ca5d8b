#include "depth_map.hpp"

#include <algorithm>
#include <array>

namespace drape::meshing {
namespace {

Eigen::Vector4f value_of(const RangeSample& s) {
  return {s.depth, s.slope_x, s.slope_y, s.weight};
}

// How much deeper than the sample its tangent plane is at a pixel, in pixels' widths.
float plane_at(const RangeSample& s, int column, int row) {
  return s.slope_x * (static_cast<float>(column) - s.column) + s.slope_y * (static_cast<float>(row) - s.row);
}

void draw(DepthMap& map, const RangeSheet& sheet, const Face& face) {
  const std::array<const RangeSample*, 3> corner{&sheet.samples[face[0]], &sheet.samples[face[1]],
                                                 &sheet.samples[face[2]]};
  const auto [left, right] = std::minmax({corner[0]->column, corner[1]->column, corner[2]->column});
  const auto [top, bottom] = std::minmax({corner[0]->row, corner[1]->row, corner[2]->row});
  const float bx = corner[1]->column - corner[0]->column;
  const float by = corner[1]->row - corner[0]->row;
  const float cx = corner[2]->column - corner[0]->column;
  const float cy = corner[2]->row - corner[0]->row;
  const float area = bx * cy - by * cx;
  if (area == 0) return;
  constexpr float slack = -1e-4F;  // a pixel on an edge belongs to both of its faces
  for (int row = static_cast<int>(std::ceil(top)); static_cast<float>(row) <= bottom; ++row)
    for (int column = static_cast<int>(std::ceil(left)); static_cast<float>(column) <= right; ++column) {
      const float x = static_cast<float>(column) - corner[0]->column;
      const float y = static_cast<float>(row) - corner[0]->row;
      const float b = (x * cy - y * cx) / area;
      const float c = (bx * y - by * x) / area;
      const float a = 1 - b - c;
      if (a < slack || b < slack || c < slack) continue;
      Eigen::Vector4f value = a * value_of(*corner[0]) + b * value_of(*corner[1]) + c * value_of(*corner[2]);
      value[0] +=
          map.bulge(value[0], a * plane_at(*corner[0], column, row) + b * plane_at(*corner[1], column, row) +
                                  c * plane_at(*corner[2], column, row));
      const std::size_t pixel = map.index(column, row);
      Eigen::Vector4f& there = map.pixels[pixel];
      if (there[3] > 0 && there[0] <= value[0]) continue;
      there = value;
      if (!map.samples.empty()) map.samples[pixel] = face[a >= b && a >= c ? 0 : (b >= c ? 1 : 2)];
    }
}

// Pixels without a value between two of one surface in the same row (stride 1) or column (stride columns).
void close_gaps(DepthMap& map, std::size_t lines, std::size_t line_stride, std::size_t length,
                std::size_t stride, float depth_step) {
  constexpr std::size_t widest = 3;
  constexpr float low_weight = 0.1F;
  for (std::size_t line = 0; line < lines; ++line) {
    std::size_t last = length;  // the last pixel with a value
    for (std::size_t i = 0; i < length; ++i) {
      const std::size_t here = line * line_stride + i * stride;
      if (!(map.pixels[here][3] > 0)) continue;
      if (last < i && i - last > 1 && i - last <= widest + 1) {
        const std::size_t before = line * line_stride + last * stride;
        const Eigen::Vector4f from = map.pixels[before];
        const Eigen::Vector4f to = map.pixels[here];
        if (std::abs(to[0] - from[0]) <= depth_step)
          for (std::size_t k = last + 1; k < i; ++k) {
            const float t = static_cast<float>(k - last) / static_cast<float>(i - last);
            const std::size_t gap = line * line_stride + k * stride;
            map.pixels[gap] = (1 - t) * from + t * to;
            map.pixels[gap][3] *= low_weight;
            if (!map.samples.empty()) map.samples[gap] = map.samples[t < 0.5F ? before : here];
          }
      }
      last = i;
    }
  }
}

// Pixels without a value beside ones with a value get the mean of what those make of them.
void add_margin(DepthMap& map) {
  constexpr float margin_weight = -1;
  const std::vector<Eigen::Vector4f> before = map.pixels;
  for (int row = 1; row + 1 < map.rows; ++row)
    for (int column = 1; column + 1 < map.columns; ++column) {
      if (before[map.index(column, row)][3] != 0) continue;
      Eigen::Vector4f sum = Eigen::Vector4f::Zero();
      float count = 0;
      for (int down = -1; down <= 1; ++down)
        for (int right = -1; right <= 1; ++right) {
          const Eigen::Vector4f& beside = before[map.index(column + right, row + down)];
          if (beside[3] == 0) continue;
          sum += map.along_plane(beside, static_cast<float>(-right), static_cast<float>(-down));
          count += 1;
        }
      if (count == 0) continue;
      Eigen::Vector4f& pixel = map.pixels[map.index(column, row)];
      pixel = sum / count;
      pixel[3] = margin_weight;
    }
}

}  // namespace

DepthMap depth_map(const RangeSheet& sheet, bool keep_samples, double longest_edge_spacings) {
  DepthMap map;
  map.sight = sheet.sight;
  if (sheet.faces.empty()) return map;
  float right = 0;
  float bottom = 0;
  float farthest = -std::numeric_limits<float>::infinity();
  for (const Face& f : sheet.faces)
    for (const std::uint32_t v : f) {
      right = std::max(right, sheet.samples[v].column);
      bottom = std::max(bottom, sheet.samples[v].row);
      farthest = std::max(farthest, sheet.samples[v].depth);
    }
  map.columns = static_cast<int>(right) + 4;
  map.rows = static_cast<int>(bottom) + 4;
  map.depth_step_ =
      static_cast<float>(longest_edge_spacings * sheet.sight.spacing_at(static_cast<double>(farthest)));
  const std::size_t size = static_cast<std::size_t>(map.columns) * static_cast<std::size_t>(map.rows);
  map.pixels.assign(size, Eigen::Vector4f::Zero());
  if (keep_samples) map.samples.assign(size, DepthMap::no_sample);
  for (const Face& f : sheet.faces) draw(map, sheet, f);
  const auto columns = static_cast<std::size_t>(map.columns);
  const auto rows = static_cast<std::size_t>(map.rows);
  close_gaps(map, rows, columns, columns, 1, map.depth_step_);
  close_gaps(map, columns, 1, rows, columns, map.depth_step_);
  constexpr int margin_pixels = 2;
  for (int i = 0; i < margin_pixels; ++i) add_margin(map);
  return map;
}

}  // namespace drape::meshing
