// Signed distances to simple solids and ways to join them (J. C. Hart, "Sphere tracing", 1996). Exact or,
// near the surface, close to it.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace drape::simulation {

inline double sphere_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& center, double radius) {
  return (p - center).norm() - radius;
}

/// First-order distance: exact on the surface, with unit gradient there.
inline double ellipsoid_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& center,
                                 const Eigen::Vector3d& radii) {
  const Eigen::Vector3d scaled = (p - center).cwiseQuotient(radii);
  const double k = scaled.norm();
  if (k < 1e-9) return -radii.minCoeff();
  return k * (k - 1) / scaled.cwiseQuotient(radii).norm();
}

/// A box whose edges are rounded with `radius`; `half` are its half extents, the rounding included.
inline double box_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& center,
                           const Eigen::Vector3d& half, double radius) {
  const Eigen::Vector3d q = (p - center).cwiseAbs() - (half.array() - radius).matrix();
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - radius;
}

/// An upright cylinder with rounded edges.
inline double cylinder_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& center, double radius,
                                double half_height, double rounding) {
  const Eigen::Vector2d q((p - center).head<2>().norm() - radius + rounding,
                          std::abs(p.z() - center.z()) - half_height + rounding);
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - rounding;
}

/// A ring about `axis` (unit length).
inline double torus_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& center,
                             const Eigen::Vector3d& axis, double ring_radius, double tube_radius) {
  const Eigen::Vector3d q = p - center;
  const double along = q.dot(axis);
  return std::hypot((q - along * axis).norm() - ring_radius, along) - tube_radius;
}

/// A limb from a to b whose radius goes linearly from radius_a to radius_b, with round ends.
inline double limb_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            double radius_a, double radius_b) {
  const Eigen::Vector3d along = b - a;
  const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - a - t * along).norm() - (radius_a + t * (radius_b - radius_a));
}

/// Both solids, with a fillet of about `width` where they meet.
inline double blend(double a, double b, double width) {
  const double near = std::max(width - std::abs(a - b), 0.0) / width;
  return std::min(a, b) - near * near * width / 4;
}

/// `solid` without `cut`, the edge rounded over about `width`.
inline double carve(double solid, double cut, double width) {
  return -blend(-solid, cut, width);
}

/// Points on a Catmull-Rom spline through `knots`, `steps` to each span, the end knots included.
template <class Vector>
std::vector<Vector> spline(const std::vector<Vector>& knots, int steps) {
  std::vector<Vector> points;
  const std::size_t spans = knots.size() - 1;
  for (std::size_t i = 0; i < spans; ++i) {
    const Vector& b = knots[i];
    const Vector& c = knots[i + 1];
    const Vector before = i > 0 ? Vector(c - knots[i - 1]) : Vector(c - b);
    const Vector after = i + 1 < spans ? Vector(knots[i + 2] - b) : Vector(c - b);
    for (int k = 0; k < steps; ++k) {
      const double t = static_cast<double>(k) / steps;
      // Hermite form with the tangents before / 2 and after / 2.
      points.push_back((2 * t * t * t - 3 * t * t + 1) * b + (t * t * t - 2 * t * t + t) * 0.5 * before +
                       (3 * t * t - 2 * t * t * t) * c + (t * t * t - t * t) * 0.5 * after);
    }
  }
  points.push_back(knots.back());
  return points;
}

/// A tube along a curve: knots hold x, y, z and the radius there.
class Tube {
 public:
  explicit Tube(const std::vector<Eigen::Vector4d>& knots, int steps = 8) : points_(spline(knots, steps)) {}

  struct Nearest {
    double distance;
    double along;  // 0 at the first knot, 1 at the last
  };
  [[nodiscard]] Nearest nearest(const Eigen::Vector3d& p) const {
    Nearest best{std::numeric_limits<double>::infinity(), 0};
    const std::size_t spans = points_.size() - 1;
    for (std::size_t i = 0; i < spans; ++i) {
      const Eigen::Vector3d a = points_[i].head<3>();
      const Eigen::Vector3d along = points_[i + 1].head<3>() - a;
      const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
      const double d = (p - a - t * along).norm() - (points_[i][3] + t * (points_[i + 1][3] - points_[i][3]));
      if (d < best.distance) best = {d, (static_cast<double>(i) + t) / static_cast<double>(spans)};
    }
    return best;
  }

 private:
  std::vector<Eigen::Vector4d> points_;
};

/// A body of revolution about z. The profile's knots hold radius and height, from the axis at the bottom to
/// the axis at the top.
class Revolution {
 public:
  explicit Revolution(const std::vector<Eigen::Vector2d>& knots, int steps = 8)
      : profile_(spline(knots, steps)) {
    for (Eigen::Vector2d& point : profile_) point.x() = std::max(point.x(), 0.0);
  }

  [[nodiscard]] double distance(const Eigen::Vector3d& p) const {
    const Eigen::Vector2d q(p.head<2>().norm(), p.z());
    double squared = std::numeric_limits<double>::infinity();
    bool inside = false;
    for (std::size_t i = 0; i + 1 < profile_.size(); ++i) {
      const Eigen::Vector2d& a = profile_[i];
      const Eigen::Vector2d along = profile_[i + 1] - a;
      const double length_squared = along.squaredNorm();
      if (length_squared == 0) continue;
      const double t = std::clamp((q - a).dot(along) / length_squared, 0.0, 1.0);
      squared = std::min(squared, (q - a - t * along).squaredNorm());
      // Crossings of the ray from q outwards.
      if ((a.y() > q.y()) != (profile_[i + 1].y() > q.y()) &&
          q.x() < a.x() + (q.y() - a.y()) / along.y() * along.x())
        inside = !inside;
    }
    return inside ? -std::sqrt(squared) : std::sqrt(squared);
  }

 private:
  std::vector<Eigen::Vector2d> profile_;
};

}  // namespace drape::simulation
