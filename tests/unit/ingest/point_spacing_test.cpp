#include "drape/ingest/point_spacing.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "analytic_scans.hpp"
#include "drape/geometry/spatial_order.hpp"

namespace drape::ingest {
namespace {

using test::scan_field;

TEST(PointSpacing, OfALatticeIsItsPitchWhateverTheSlope) {
  const auto box = test::box_field({20, 20, 20});
  // Both steep faces of the box are seen at 45 degrees: neighbours lie sqrt(2) apart in space on one axis.
  const RangeScan scan = scan_field(box, test::rotation_deg(45, Eigen::Vector3d::UnitY()), {.pitch = 0.5});
  EXPECT_NEAR(point_spacing(scan), 0.5, 1e-9);
}

TEST(PointSpacing, OfALatticeIsNotInflatedByNoise) {
  const RangeScan scan = scan_field(test::box_field({40, 40, 5}), Rigid3::Identity(), {.noise = 1.0});
  EXPECT_NEAR(point_spacing(scan), 1.0, 1e-9);
  EXPECT_GT(point_spacing(test::without_grid(scan)), 1.2) << "what the lattice saves us from";
}

TEST(PointSpacing, FindsTheRaysOfALatticeWithoutView) {
  const RangeScan scan =
      test::without_view(scan_field(test::sphere_field(25), Rigid3::Identity(), {.noise = 0.3}));
  // A regression over 2,000 points finds the ray to a few milliradians.
  EXPECT_NEAR(point_spacing(scan), 1.0, 0.01);
}

TEST(PointSpacing, OfDifferentStepsIsTheirGeometricMean) {
  RangeScan scan = scan_field(test::box_field({200, 200, 5}), Rigid3::Identity(), {});
  for (auto& p : scan.cloud.positions) p.y() *= 4;
  EXPECT_NEAR(point_spacing(scan), 2.0, 1e-9);
}

TEST(PointSpacing, OfDivergingRaysHoldsAtTheMedianRange) {
  const RangeScan scan =
      scan_field(test::box_field({400, 400, 5}), Rigid3::Identity(), {.pitch = 2, .diverging = true});
  // The wall lies 195 from the scanner instead of 200; off the axis its samples spread by 1 / cos(angle).
  EXPECT_NEAR(point_spacing(scan), 2.0 * 195 / 200, 0.05);
  const LocalSpacing local(scan, 2.0);
  EXPECT_NEAR(local.ratio({0, 0, 5 - 195}) / local.ratio({0, 0, 5}), 2.0, 1e-9);
}

TEST(PointSpacing, WithoutGridComesFromTheNearestNeighbours) {
  const RangeScan scan = test::without_grid(scan_field(test::box_field({40, 40, 5}), Rigid3::Identity(), {}));
  EXPECT_NEAR(point_spacing(scan), 1.0, 1e-9);
}

TEST(PointSpacing, OfNoPointsOrOneIsZero) {
  RangeScan scan;
  EXPECT_EQ(point_spacing(scan), 0.0);
  scan.cloud.positions = {{1, 2, 3}};
  EXPECT_EQ(point_spacing(scan), 0.0);
  scan.grid = RangeGrid{1, 1, {0}};
  EXPECT_EQ(point_spacing(scan), 0.0);
  scan.grid.reset();
  scan.cloud.positions.emplace_back(1, 2, 5);
  EXPECT_EQ(point_spacing(scan), 2.0);
}

TEST(SpatialOrder, IsAPermutationWithEqualPointsSideBySide) {
  Rng rng(3);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 500; ++i) points.emplace_back(rng.uniform(), rng.uniform(), rng.uniform());
  points.insert(points.end(), points.begin(), points.begin() + 100);
  const auto order = morton_order(points);
  auto sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (std::uint32_t i = 0; i < sorted.size(); ++i) EXPECT_EQ(sorted[i], i);
  std::size_t pairs = 0;
  for (std::size_t i = 1; i < order.size(); ++i)
    if (points[order[i]] == points[order[i - 1]]) {
      EXPECT_LT(order[i - 1], order[i]);
      ++pairs;
    }
  EXPECT_EQ(pairs, 100U);
}

TEST(SpatialOrder, KeepsNeighboursTogether) {
  Rng rng(4);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 4096; ++i) points.emplace_back(rng.uniform(), rng.uniform(), rng.uniform());
  const auto order = morton_order(points);
  double walk = 0;
  for (std::size_t i = 1; i < order.size(); ++i) walk += (points[order[i]] - points[order[i - 1]]).norm();
  // Random order takes 0.66 a step; 16 cells an axis, mostly one cell a step, give 1/16 and some jumps.
  EXPECT_LT(walk / 4095, 0.15);
}

}  // namespace
}  // namespace drape::ingest
