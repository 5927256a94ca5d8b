#include "polar_view.hpp"

#include "fast_popcount.hpp"

namespace drape::alignment {

PolarFrame polar_frame(const BitImage& image) {
  double count = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  for (int y = 0; y < image.height(); ++y) {
    double in_row = 0;
    const std::span<const std::uint64_t> row = image.row(y);
    for (std::size_t i = 0; i < row.size(); ++i)
      for (std::uint64_t rest = row[i]; rest != 0; rest &= rest - 1) {
        const double x = static_cast<double>(64 * i) + std::countr_zero(rest) + 0.5;
        ++in_row;
        sum.x() += x;
        squares.x() += x * x;
      }
    count += in_row;
    sum.y() += in_row * (y + 0.5);
    squares.y() += in_row * (y + 0.5) * (y + 0.5);
  }
  if (count == 0) return {Eigen::Vector2d::Zero(), 0};
  PolarFrame frame;
  frame.center = sum / count;
  frame.radius = std::sqrt((squares / count - frame.center.cwiseAbs2()).sum());
  return frame;
}

DRAPE_FAST_POPCOUNT
void score_rolls(const PolarStencil& stencil, const PolarBits& view, std::span<float, polar_angles> scores) {
  int object = 0;
  for (int i = 0; i < polar_rings; ++i)
    object += (2 * i + 1) * __builtin_popcountll(stencil.object[static_cast<std::size_t>(i)]);
  for (int roll = 0; roll < polar_angles; ++roll) {
    int both = 0;
    int model = 0;
    for (int i = 0; i < polar_rings; ++i) {
      const auto ring = static_cast<std::size_t>(i);
      const std::uint64_t turned = std::rotl(view[ring], roll) & stencil.known[ring];
      both += (2 * i + 1) * __builtin_popcountll(turned & stencil.object[ring]);
      model += (2 * i + 1) * __builtin_popcountll(turned);
    }
    const int either = object + model - both;
    scores[static_cast<std::size_t>(roll)] =
        either == 0 ? 0.0F : static_cast<float>(both) / static_cast<float>(either);
  }
}

}  // namespace drape::alignment
