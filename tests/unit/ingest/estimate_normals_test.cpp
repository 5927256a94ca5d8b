#include "drape/ingest/estimate_normals.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "analytic_scans.hpp"
#include "drape/base/parallel.hpp"

namespace drape::ingest {
namespace {

using test::scan_field;

double angle_deg(const Eigen::Vector3f& n, const Eigen::Vector3d& truth) {
  return std::acos(std::clamp(n.cast<double>().dot(truth), -1.0, 1.0)) * 180 / std::numbers::pi;
}

// Angles between the estimated and the true outward normals of a sphere round the origin of the scan's frame.
std::vector<double> sphere_errors_deg(const RangeScan& scan, const std::vector<Eigen::Vector3f>& normals) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < normals.size(); ++i)
    errors.push_back(angle_deg(normals[i], scan.cloud.positions[i].normalized()));
  std::sort(errors.begin(), errors.end());
  return errors;
}

TEST(EstimateNormals, OfASphereFromTheLattice) {
  const RangeScan scan = scan_field(test::sphere_field(25), Rigid3::Identity(), {});
  const auto errors = sphere_errors_deg(scan, estimate_normals(scan));
  EXPECT_LT(errors[errors.size() / 2], 0.5);
  // At the rim the disc of neighbours is cut off: half its radius of 2.5 / 25 radians, and the slope
  // stretches it.
  EXPECT_LT(errors[errors.size() * 9 / 10], 5.0);
  EXPECT_LT(errors.back(), 30.0) << "all point to the scanner";
}

TEST(EstimateNormals, NoiseShrinksWithTheRadius) {
  const RangeScan scan = scan_field(test::box_field({100, 100, 5}), Rigid3::Identity(), {.noise = 0.3});
  const auto median_error = [&](const std::vector<Eigen::Vector3f>& normals) {
    std::vector<double> errors;
    for (const auto& n : normals) errors.push_back(angle_deg(n, Eigen::Vector3d::UnitZ()));
    std::sort(errors.begin(), errors.end());
    return errors[errors.size() / 2];
  };
  // Slope error of a plane fit: noise / sqrt(sum x^2) on each axis; its length has the median 1.18 of one
  // axis's.
  const auto expected_deg = [](double radius) {
    double sum = 0;
    for (int x = -8; x <= 8; ++x)
      for (int y = -8; y <= 8; ++y)
        if (std::hypot(x, y) <= radius) sum += x * x;
    return 1.18 * 0.3 / std::sqrt(sum) * 180 / std::numbers::pi;
  };
  for (const double radius : {1.5, 2.5, 5.0})
    EXPECT_NEAR(median_error(estimate_normals(scan, radius)) / expected_deg(radius), 1.0, 0.15) << radius;
}

TEST(EstimateNormals, DoNotReachAcrossADepthEdge) {
  // A wall behind a plate, both facing the scanner: any plane through both would lean.
  const auto field = test::united(test::box_field({100, 100, 1}),
                                  [plate = test::box_field({10, 10, 1})](const Eigen::Vector3d& p) {
                                    return plate(p - Eigen::Vector3d(0, 0, 30));
                                  });
  const RangeScan scan = scan_field(field, Rigid3::Identity(), {});
  for (const auto& n : estimate_normals(scan)) EXPECT_LT(angle_deg(n, Eigen::Vector3d::UnitZ()), 1e-3);
}

TEST(EstimateNormals, WithoutGridFromTheNearestPoints) {
  const RangeScan scan = test::without_grid(scan_field(test::sphere_field(25), Rigid3::Identity(), {}));
  const auto errors = sphere_errors_deg(scan, estimate_normals(scan));
  EXPECT_LT(errors[errors.size() / 2], 0.5);
  EXPECT_LT(errors[errors.size() * 9 / 10], 5.0);
}

TEST(EstimateNormals, WithoutViewTheLatticeTellsTheSide) {
  const RangeScan scan = test::without_view(scan_field(test::sphere_field(25), Rigid3::Identity(), {}));
  const auto errors = sphere_errors_deg(scan, estimate_normals(scan));
  EXPECT_LT(errors.back(), 30.0);
}

TEST(EstimateNormals, WithoutViewAndGridPropagateOverClosedShapes) {
  // A torus: no point of view sees all of it, and its inside faces its centre.
  RangeScan scan;
  std::vector<Eigen::Vector3d> truth;
  for (int i = 0; i < 120; ++i)
    for (int j = 0; j < 40; ++j) {
      const double u = 2 * std::numbers::pi * i / 120;
      const double v = 2 * std::numbers::pi * j / 40;
      const Eigen::Vector3d around(std::cos(u), std::sin(u), 0);
      truth.emplace_back(std::cos(v) * around + std::sin(v) * Eigen::Vector3d::UnitZ());
      scan.cloud.positions.emplace_back(30 * around + 10 * truth.back());
    }
  const auto normals = estimate_normals(scan);
  for (std::size_t i = 0; i < normals.size(); ++i) EXPECT_LT(angle_deg(normals[i], truth[i]), 10.0);
}

TEST(EstimateNormals, WithoutViewEachPartTurnsOutwardOfItself) {
  RangeScan scan;
  for (const double x : {0.0, 200.0}) {
    const RangeScan one = scan_field(test::sphere_field(25), Rigid3::Identity(), {});
    for (const auto& p : one.cloud.positions) scan.cloud.positions.emplace_back(p + Eigen::Vector3d(x, 0, 0));
  }
  const auto normals = estimate_normals(scan);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Eigen::Vector3d center(scan.cloud.positions[i].x() < 100 ? 0 : 200, 0, 0);
    EXPECT_LT(angle_deg(normals[i], (scan.cloud.positions[i] - center).normalized()), 30.0);
  }
}

TEST(EstimateNormals, TurnWithARigidMotion) {
  const RangeScan scan =
      test::without_grid(scan_field(test::sphere_field(25), Rigid3::Identity(), {.noise = 0.1}));
  const Rigid3 motion = Eigen::Translation3d(1000, -500, 20) * test::rotation_deg(77, {1, 2, 3});
  RangeScan moved = scan;
  for (auto& p : moved.cloud.positions) p = motion * p;
  moved.view.vector = motion.linear() * moved.view.vector;
  const auto before = estimate_normals(scan);
  const auto after = estimate_normals(moved);
  std::size_t equal = 0;
  for (std::size_t i = 0; i < before.size(); ++i)
    equal += angle_deg(after[i], motion.linear() * before[i].cast<double>()) < 0.1 ? 1 : 0;
  EXPECT_GE(equal, before.size() * 98 / 100) << "but for ties among the furthest neighbours";
}

TEST(EstimateNormals, AreTheSameBytesForAnyNumberOfThreads) {
  const RangeScan lattice = scan_field(test::sphere_field(25), Rigid3::Identity(), {.noise = 0.1});
  for (const RangeScan& scan :
       {lattice, test::without_grid(lattice), test::without_view(test::without_grid(lattice))}) {
    set_thread_count(1);
    const auto one = estimate_normals(scan);
    set_thread_count(4);
    const auto four = estimate_normals(scan);
    set_thread_count(0);
    EXPECT_EQ(one, four);
  }
}

TEST(EstimateNormals, OfFewOrCollinearPointsAreUnitVectorsAcrossThem) {
  for (const int count : {0, 1, 2, 3, 40}) {
    RangeScan scan;
    for (int i = 0; i < count; ++i) scan.cloud.positions.emplace_back(i, 2.0 * i, 0.5 * i);
    const auto normals = estimate_normals(scan);
    ASSERT_EQ(normals.size(), static_cast<std::size_t>(count));
    for (const auto& n : normals) {
      EXPECT_NEAR(n.norm(), 1.0F, 1e-5F);
      if (count > 1) {
        EXPECT_NEAR(n.dot(Eigen::Vector3f(1, 2, 0.5F)), 0.0F, 1e-4F);
      }
    }
  }
}

TEST(EstimateNormals, OfAllDuplicatesAreUnitVectors) {
  RangeScan scan;
  scan.cloud.positions.assign(100, {3, 4, 5});
  for (const auto& n : estimate_normals(scan)) EXPECT_NEAR(n.norm(), 1.0F, 1e-5F);
}

}  // namespace
}  // namespace drape::ingest
