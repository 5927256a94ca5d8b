// Colours as functions of position. All are sRGB-encoded.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "drape/base/random.hpp"

namespace drape::simulation {

using Color = Eigen::Vector3f;

/// 0 at t = 0, 1 at t = 1, with flat ends; clamped outside.
inline double ease(double t) {
  const double x = std::clamp(t, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

inline Color mix(const Color& a, const Color& b, double share_of_b) {
  const float t = static_cast<float>(std::clamp(share_of_b, 0.0, 1.0));
  return a + t * (b - a);
}

/// A uniform number in 0..1 that belongs to a cell of the integer lattice.
inline double cell_random(const Eigen::Vector3i& cell, std::uint64_t salt) {
  // Odd factors mix the coordinates; item_seed scrambles the sum.
  const std::uint64_t sum = static_cast<std::uint32_t>(cell.x()) * 0x8da6b343ULL +
                            static_cast<std::uint32_t>(cell.y()) * 0xd8163841cb1ab5ULL +
                            static_cast<std::uint32_t>(cell.z()) * 0x1b873593cc9e2d51ULL;
  return static_cast<double>(item_seed(sum, salt) >> 11) * 0x1.0p-53;
}

/// Smooth random field in 0..1 with features of size 1: lattice values, eased trilinear interpolation
/// (Perlin 1985's value noise).
inline double value_noise(const Eigen::Vector3d& p, std::uint64_t salt) {
  const Eigen::Vector3d base = p.array().floor();
  const Eigen::Vector3i cell = base.cast<int>();
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3i offset(corner & 1, (corner >> 1) & 1, corner >> 2);
    double weight = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double t = ease(p[axis] - base[axis]);
      weight *= offset[axis] != 0 ? t : 1 - t;
    }
    sum += weight * cell_random(cell + offset, salt);
  }
  return sum;
}

/// Four octaves of value_noise, 0..1, about 0.5.
inline double cloud_noise(const Eigen::Vector3d& p, std::uint64_t salt) {
  double sum = 0;
  double amplitude = 0.5;
  for (int octave = 0; octave < 4; ++octave, amplitude /= 2)
    sum += amplitude * value_noise(p * std::exp2(octave), salt + static_cast<std::uint64_t>(octave));
  return sum / 0.9375;
}

/// Whether p lies in a speckle: of the cells of a lattice of `pitch`, a share of `density` holds one ball
/// each, of radius up to a third of the pitch.
inline bool in_speckle(const Eigen::Vector3d& p, double pitch, double density, std::uint64_t salt) {
  const Eigen::Vector3d q = p / pitch;
  const Eigen::Vector3i cell = q.array().floor().cast<int>();
  if (cell_random(cell, salt) >= density) return false;
  const double radius = 0.12 + 0.2 * cell_random(cell, salt + 1);
  Eigen::Vector3d center = cell.cast<double>();
  for (int axis = 0; axis < 3; ++axis)
    center[axis] += 0.35 + 0.3 * cell_random(cell, salt + 2 + static_cast<std::uint64_t>(axis));
  return (q - center).squaredNorm() < radius * radius;
}

}  // namespace drape::simulation
