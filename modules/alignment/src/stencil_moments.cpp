#include "stencil_moments.hpp"

#include <cassert>
#include <cmath>

namespace drape::alignment {

Moments moments_of(const Image8& stencil, const Image8& known) {
  assert(stencil.width() <= 1024 && stencil.height() <= 1024);
  std::int64_t count = 0;
  std::int64_t sum_x = 0, sum_xx = 0, sum_y = 0, sum_yy = 0;
  for (int y = 0; y < stencil.height(); ++y) {
    const auto pixels = stencil.row(y);
    const auto counted = known.row(y);
    // 32 bits hold the sums of one row of 1024 pixels, and let the loop be vectorised.
    std::uint32_t row = 0, row_x = 0, row_xx = 0;
    for (std::uint32_t x = 0; x < pixels.size(); ++x) {
      const std::uint32_t one = (pixels[x] == stencil::object ? 1U : 0U) & counted[x];
      row += one;
      row_x += one * x;
      row_xx += one * x * x;
    }
    count += row;
    sum_x += row_x;
    sum_xx += row_xx;
    sum_y += static_cast<std::int64_t>(row) * y;
    sum_yy += static_cast<std::int64_t>(row) * y * y;
  }
  Moments moments;
  moments.pixels = count;
  if (count == 0) return moments;
  const auto n = static_cast<double>(count);
  const auto deviation = [n](std::int64_t sum, std::int64_t squares) {
    const double mean = static_cast<double>(sum) / n;
    return std::sqrt(std::max(0.0, static_cast<double>(squares) / n - mean * mean));
  };
  moments.center << static_cast<double>(sum_x) / n + 0.5, static_cast<double>(sum_y) / n + 0.5;
  moments.deviation << deviation(sum_x, sum_xx), deviation(sum_y, sum_yy);
  return moments;
}

}  // namespace drape::alignment
