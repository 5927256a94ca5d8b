// What a scan sees along each of its lines of sight.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "range_sheet.hpp"

namespace drape::meshing {

/// A picture of depths. The value of a pixel is (depth, slope_x, slope_y, weight); weight 0: nothing was seen
/// there; less: nothing was seen there either, but the surface beside it would be there if it went on.
struct DepthMap {
  static constexpr std::uint32_t no_sample = 0xffffffffU;

  Sight sight;
  int columns = 0;
  int rows = 0;
  std::vector<Eigen::Vector4f> pixels;
  std::vector<std::uint32_t> samples;  // per pixel the scan's nearest point, or no_sample; may be empty
  std::size_t scan = 0;                // which one this is of
  double noise = 0;                    // of the sheet's samples across the surface, a length

  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }

  /// What is to be added to a depth between samples or pixels, weighted by their places, where their tangent
  /// planes, weighted alike, lie `planes` pixels' widths off it. A surface that bends lies in the middle
  /// between its chords and its tangent planes, exactly so where it is quadratic.
  [[nodiscard]] float bulge(float depth, float planes) const {
    return 0.5F * planes * static_cast<float>(sight.width_at(static_cast<double>(depth)));
  }

  /// Quadratic between pixels of one surface, the nearest pixel's tangent plane beside an edge; weight 0 if
  /// that one has none.
  [[nodiscard]] Eigen::Vector4f at(float column, float row) const {
    if (!(column >= 0 && row >= 0 && column < static_cast<float>(columns - 1) &&
          row < static_cast<float>(rows - 1)))
      return Eigen::Vector4f::Zero();
    const int c = static_cast<int>(column);
    const int r = static_cast<int>(row);
    const float u = column - static_cast<float>(c);
    const float v = row - static_cast<float>(r);
    const Eigen::Vector4f* const upper = &pixels[index(c, r)];
    const Eigen::Vector4f* const lower = upper + columns;
    const Eigen::Vector4f& nearest = (v < 0.5F ? upper : lower)[u < 0.5F ? 0 : 1];
    if (nearest[3] == 0) return Eigen::Vector4f::Zero();
    if (!(nearest[3] > 0 && one_surface(nearest, upper[0]) && one_surface(nearest, upper[1]) &&
          one_surface(nearest, lower[0]) && one_surface(nearest, lower[1])))
      return along_plane(nearest, u - (u < 0.5F ? 0.0F : 1.0F), v - (v < 0.5F ? 0.0F : 1.0F));
    Eigen::Vector4f value =
        (1 - v) * ((1 - u) * upper[0] + u * upper[1]) + v * ((1 - u) * lower[0] + u * lower[1]);
    const float across =
        (1 - u) * u * ((1 - v) * (upper[0][1] - upper[1][1]) + v * (lower[0][1] - lower[1][1]));
    const float down =
        (1 - v) * v * ((1 - u) * (upper[0][2] - lower[0][2]) + u * (upper[1][2] - lower[1][2]));
    value[0] += bulge(value[0], across + down);
    return value;
  }

  /// Of the pixel that the place lies in; nullptr outside of the picture.
  [[nodiscard]] const Eigen::Vector4f* nearest(float column, float row) const {
    if (!(column >= 0 && row >= 0 && column < static_cast<float>(columns - 1) &&
          row < static_cast<float>(rows - 1)))
      return nullptr;
    return &pixels[index(static_cast<int>(column + 0.5F), static_cast<int>(row + 0.5F))];
  }

  /// A pixel's value that many pixels to the right and down on its tangent plane.
  [[nodiscard]] Eigen::Vector4f along_plane(const Eigen::Vector4f& pixel, float right, float down) const {
    const auto width = static_cast<float>(sight.width_at(static_cast<double>(pixel[0])));
    return {pixel[0] + width * (right * pixel[1] + down * pixel[2]), pixel[1], pixel[2], pixel[3]};
  }

 private:
  [[nodiscard]] bool one_surface(const Eigen::Vector4f& a, const Eigen::Vector4f& b) const {
    return b[3] > 0 && std::abs(a[0] - b[0]) <= depth_step_;
  }
  float depth_step_ = 0;  // more than this between pixels is an edge
  friend DepthMap depth_map(const RangeSheet& sheet, bool keep_samples, double longest_edge_spacings);
};

/// The sheet's faces drawn into a picture, nearest in front; gaps of up to three pixels between pixels of one
/// surface closed at a low weight; a margin of two pixels round it of a weight below 0. With `keep_samples`
/// it knows the samples too.
[[nodiscard]] DepthMap depth_map(const RangeSheet& sheet, bool keep_samples, double longest_edge_spacings);

}  // namespace drape::meshing
