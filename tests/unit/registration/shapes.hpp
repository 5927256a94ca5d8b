// Shapes whose scans hold each other in every direction, and how far a registration is from the truth.
#pragma once

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "analytic_scans.hpp"
#include "drape/registration/register_scans.hpp"

namespace drape::test {

/// A sheet with waves along x and y.
inline DistanceField wavy_field() {
  return [](const Eigen::Vector3d& p) {
    const double height = 4 * std::sin(p.x() / 7) + 3 * std::cos(p.y() / 6 + 0.5);
    return 0.6 * (p.z() - height);  // slopes up to 0.76: 0.6 of the difference is never beyond the surface
  };
}

/// Three balls of different sizes, each in front of the next.
inline DistanceField balls_field() {
  return united(united(sphere_field(16, {-10, 0, 0}), sphere_field(11, {14, 6, 2})),
                sphere_field(9, {4, -16, 3}));
}

/// Scans of a field from above, tilted to both sides: the poses are the truth.
struct ScannedShape {
  std::vector<RangeScan> scans;
  std::vector<Rigid3> world_from_scan;

  [[nodiscard]] std::vector<std::optional<Rigid3>> given() const {
    return {world_from_scan.begin(), world_from_scan.end()};
  }
};

inline ScannedShape scan_from_sides(const DistanceField& field, double noise, bool diverging = false) {
  ScannedShape shape;
  const std::vector<Rigid3> poses{rotation_deg(0, Eigen::Vector3d::UnitX()),
                                  Eigen::Translation3d(1, 2, 3) * rotation_deg(25, {1, 0.2, 0}),
                                  Eigen::Translation3d(-2, 0, 1) * rotation_deg(-25, {0.3, 1, 0.1})};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    shape.scans.push_back(
        scan_field(field, poses[i], {.noise = noise, .seed = i + 1, .diverging = diverging}));
    shape.scans.back().file = "side" + std::to_string(i) + ".ply";
    shape.world_from_scan.push_back(poses[i]);
  }
  return shape;
}

/// A pose turned by `degrees` about a point of the shape and shifted by `shift`, both in a random direction.
inline Rigid3 perturbed(const Rigid3& pose, double degrees, double shift, std::uint64_t seed) {
  Rng rng(seed);
  const auto direction = [&] {
    return Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
  };
  const Eigen::Vector3d axis = direction();
  return Eigen::Translation3d(shift * direction()) * rotation_deg(degrees, axis) * pose;
}

/// The same scans, each in a frame of its own that is turned and shifted anyhow.
inline ScannedShape turned_anyhow(ScannedShape shape, std::uint64_t seed) {
  Rng rng(seed);
  for (std::size_t i = 0; i < shape.scans.size(); ++i) {
    Eigen::Quaterniond turn(rng.normal(), rng.normal(), rng.normal(), rng.normal());
    Rigid3 own_from_scan(turn.normalized());
    own_from_scan.translation() = 50 * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal());
    RangeScan& scan = shape.scans[i];
    for (auto& p : scan.cloud.positions) p = own_from_scan * p;
    for (auto& n : scan.cloud.normals) n = own_from_scan.linear().cast<float>() * n;
    scan.view.vector = scan.view.kind == ScanView::Kind::origin
                           ? Eigen::Vector3d(own_from_scan * scan.view.vector)
                           : Eigen::Vector3d(own_from_scan.linear() * scan.view.vector);
    shape.world_from_scan[i] = shape.world_from_scan[i] * own_from_scan.inverse();
  }
  return shape;
}

/// Mean distance of the scans' points from where the true poses put them relative to the first scan.
inline double relative_error(const ScannedShape& shape, const registration::Registration& found) {
  const Rigid3 true_from_found = shape.world_from_scan[0] * found.scans[0].world_from_scan.inverse();
  double sum = 0;
  double count = 0;
  for (std::size_t i = 1; i < shape.scans.size(); ++i)
    for (const auto& p : shape.scans[i].cloud.positions) {
      sum += (true_from_found * found.scans[i].world_from_scan * p - shape.world_from_scan[i] * p).norm();
      count += 1;
    }
  return sum / count;
}

}  // namespace drape::test
