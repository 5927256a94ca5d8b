// Range scans of shapes that are known in closed form: every hit is exact, so what a test finds is what it
// put in.
#pragma once

#include <cmath>
#include <functional>
#include <optional>

#include "drape/base/random.hpp"
#include "drape/geometry/range_scan.hpp"

namespace drape::test {

/// Signed distance to a surface, or a lower bound of its size: negative inside.
using DistanceField = std::function<double(const Eigen::Vector3d&)>;

struct LatticeSetup {
  int rows = 60;
  int columns = 60;
  double pitch = 1.0;       // across parallel rays
  double distance = 200;    // from the scanner to the frame's origin
  double most_depth = 400;  // rays end here
  double noise = 0;         // standard deviation along the ray
  std::uint64_t seed = 1;
  bool diverging = false;  // rays from one point, `pitch` apart at `distance`
};

/// Where a ray meets the surface, by sphere tracing (Hart 1996).
inline std::optional<double> hit(const DistanceField& field, const Eigen::Vector3d& origin,
                                 const Eigen::Vector3d& direction, double most) {
  double depth = 0;
  for (int step = 0; step < 2000 && depth < most; ++step) {
    const double distance = field(origin + depth * direction);
    if (std::abs(distance) < 1e-10) return depth;
    depth += distance;
  }
  return std::nullopt;
}

/// A scanner at (0, 0, distance) of the scan's frame that looks along -z; columns run along x, rows along
/// -y. The field is given in the world.
inline RangeScan scan_field(const DistanceField& field, const Rigid3& world_from_scan,
                            const LatticeSetup& setup) {
  Rng rng(setup.seed);
  RangeScan scan;
  scan.file = "analytic.ply";
  scan.grid = RangeGrid{setup.rows, setup.columns, {}};
  const Eigen::Vector3d eye(0, 0, setup.distance);
  scan.view = setup.diverging ? ScanView{ScanView::Kind::origin, eye}
                              : ScanView{ScanView::Kind::direction, -Eigen::Vector3d::UnitZ()};
  for (int row = 0; row < setup.rows; ++row)
    for (int column = 0; column < setup.columns; ++column) {
      const Eigen::Vector3d on_plane((column - (setup.columns - 1) / 2.0) * setup.pitch,
                                     ((setup.rows - 1) / 2.0 - row) * setup.pitch, 0);
      const Eigen::Vector3d origin = setup.diverging ? eye : Eigen::Vector3d(on_plane + eye);
      const Eigen::Vector3d direction = (on_plane - origin).normalized();
      const double error = setup.noise * rng.normal();
      const auto depth =
          hit(field, world_from_scan * origin, world_from_scan.linear() * direction, setup.most_depth);
      scan.grid->cells.push_back(depth ? static_cast<std::int32_t>(scan.cloud.size()) : RangeGrid::missing);
      if (depth) scan.cloud.positions.emplace_back(origin + (*depth + error) * direction);
    }
  return scan;
}

/// The same points without the lattice.
inline RangeScan without_grid(RangeScan scan) {
  scan.grid.reset();
  return scan;
}

inline RangeScan without_view(RangeScan scan) {
  scan.view = {};
  return scan;
}

inline DistanceField sphere_field(double radius, const Eigen::Vector3d& center = Eigen::Vector3d::Zero()) {
  return [=](const Eigen::Vector3d& p) { return (p - center).norm() - radius; };
}

/// An axis-aligned box round the origin.
inline DistanceField box_field(const Eigen::Vector3d& half_sizes) {
  return [=](const Eigen::Vector3d& p) {
    const Eigen::Vector3d q = p.cwiseAbs() - half_sizes;
    return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
  };
}

inline DistanceField united(const DistanceField& a, const DistanceField& b) {
  return [=](const Eigen::Vector3d& p) { return std::min(a(p), b(p)); };
}

inline Rigid3 rotation_deg(double degrees, const Eigen::Vector3d& axis) {
  return Rigid3(Eigen::AngleAxisd(degrees * 3.14159265358979323846 / 180, axis.normalized()));
}

}  // namespace drape::test
