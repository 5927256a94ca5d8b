// Simple solids as Distance functions: what objects are composed of.
#pragma once

#include <utility>

#include "distance_functions.hpp"
#include "implicit_shape.hpp"
#include "paint.hpp"

namespace drape::simulation {

inline Distance limb(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius_a, double radius_b) {
  return [=](const Eigen::Vector3d& p) { return limb_distance(p, a, b, radius_a, radius_b); };
}
inline Distance ellipsoid(const Eigen::Vector3d& center, const Eigen::Vector3d& radii) {
  return [=](const Eigen::Vector3d& p) { return ellipsoid_distance(p, center, radii); };
}
inline Distance box(const Eigen::Vector3d& center, const Eigen::Vector3d& half, double rounding) {
  return [=](const Eigen::Vector3d& p) { return box_distance(p, center, half, rounding); };
}

enum class Axis { x, y, z };

/// A cylinder along an axis, with rounded edges.
inline Distance cylinder(Axis axis, const Eigen::Vector3d& center, double radius, double half_length,
                         double rounding) {
  return [=](const Eigen::Vector3d& p) {
    Eigen::Vector3d q = p - center;
    if (axis == Axis::x) std::swap(q.x(), q.z());
    if (axis == Axis::y) std::swap(q.y(), q.z());
    return cylinder_distance(q, Eigen::Vector3d::Zero(), radius, half_length, rounding);
  };
}

/// A colour with darker grain of this pitch in it.
inline Color grained(const Color& color, const Eigen::Vector3d& p, double pitch, double strength) {
  return mix(color, Color::Zero(), strength * (cloud_noise(p / pitch, 41) - 0.2));
}
inline Paint plain(const Color& color, double pitch = 6, double strength = 0.35) {
  return [=](const Eigen::Vector3d& p) { return grained(color, p, pitch, strength); };
}

}  // namespace drape::simulation
