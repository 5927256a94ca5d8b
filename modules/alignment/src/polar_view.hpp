// Outlines on rings about their centre, where a turn in the image is a rotation of words.
#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>

#include "bit_raster.hpp"

namespace drape::alignment {

inline constexpr int polar_rings = 32;
inline constexpr int polar_angles = 64;
inline constexpr double polar_reach = 2.8;  // of the outermost ring, in radii of gyration

/// Bit j of word i: ring i from the inside, at the angle 2 pi j / 64 from x towards y.
using PolarBits = std::array<std::uint64_t, polar_rings>;

/// The centre and the radius of gyration that rings are laid about.
struct PolarFrame {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double radius = 1;
};

/// Of the pixels that are set. Nothing set: radius 0.
[[nodiscard]] PolarFrame polar_frame(const BitImage& image);

/// Where the sample (ring, angle) lies.
[[nodiscard]] inline Eigen::Vector2d polar_offset(int ring, int angle) {
  const double r = (ring + 0.5) * polar_reach / polar_rings;
  const double phi = 2 * std::numbers::pi * angle / polar_angles;
  return {r * std::cos(phi), r * std::sin(phi)};
}

/// visit(ring, angle, x, y) for every ring and angle about the frame.
template <class Visit>
void visit_polar(const PolarFrame& frame, Visit visit) {
  static const auto offsets = [] {
    std::array<std::pair<double, double>, polar_rings * polar_angles> table;
    for (int i = 0; i < polar_rings * polar_angles; ++i) {
      const Eigen::Vector2d offset = polar_offset(i / polar_angles, i % polar_angles);
      table[static_cast<std::size_t>(i)] = {offset.x(), offset.y()};
    }
    return table;
  }();
  for (std::size_t i = 0; i < polar_rings; ++i)
    for (std::size_t j = 0; j < polar_angles; ++j) {
      const auto& [dx, dy] = offsets[i * polar_angles + j];
      visit(i, j, frame.center.x() + frame.radius * dx, frame.center.y() + frame.radius * dy);
    }
}

/// sample(x, y) -> bool for every ring and angle about the frame.
template <class Sample>
[[nodiscard]] PolarBits polar_bits(const PolarFrame& frame, Sample sample) {
  PolarBits bits{};
  visit_polar(frame, [&](std::size_t ring, std::size_t angle, double x, double y) {
    if (sample(x, y)) bits[ring] |= std::uint64_t{1} << angle;
  });
  return bits;
}

/// What a photo's stencil is on the rings.
struct PolarStencil {
  PolarBits object{};
  PolarBits known{};
};

/// Intersection over union, 0..1, of the stencil and the view turned by roll * 2 pi / 64, for every roll. A
/// sample counts as much as the area it stands for; unknown ones do not.
void score_rolls(const PolarStencil& stencil, const PolarBits& view, std::span<float, polar_angles> scores);

}  // namespace drape::alignment
