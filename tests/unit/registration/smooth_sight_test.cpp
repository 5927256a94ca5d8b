#include "smooth_sight.hpp"

#include <gtest/gtest.h>

#include "drape/ingest/estimate_normals.hpp"
#include "kept_points.hpp"
#include "shapes.hpp"

namespace drape::registration {
namespace {

constexpr double voxel = 1.6;
constexpr double noise = 0.9;  // more than half a voxel

struct Seen {
  explicit Seen(const RangeScan& scan)
      : surface(scan, ingest::estimate_normals(scan)), coarse(surface, voxel), sight(surface, coarse) {}
  Seen(const Seen&) = delete;
  Seen& operator=(const Seen&) = delete;

  ScanSurface surface;
  CoarseScan coarse;
  SmoothSight sight;
};

SightShares compared(const test::ScannedShape& shape, const Rigid3& moved) {
  const Seen viewer(shape.scans[0]);
  const Seen source(shape.scans[1]);
  return viewer.sight.compare(
      source.coarse, moved * shape.world_from_scan[0].inverse() * shape.world_from_scan[1], 0.8 * noise);
}

TEST(SmoothSight, NothingOfARightPairContradictsThoughItIsNoisy) {
  const SightShares shares = compared(test::scan_from_sides(test::balls_field(), noise), Rigid3::Identity());
  EXPECT_GT(shares.agreeing, 0.3);
  EXPECT_LT(shares.in_front, 0.01 * shares.agreeing);
  EXPECT_LT(shares.in_void, 0.01 * shares.agreeing);
}

TEST(SmoothSight, TwoDeviationsTowardsTheScannerShow) {
  const Rigid3 nearer(Eigen::Translation3d(0, 0, 2 * noise));
  const SightShares shares = compared(test::scan_from_sides(test::balls_field(), noise), nearer);
  EXPECT_GT(shares.in_front, 0.1);
}

TEST(SmoothSight, WhatLiesBehindIsHidden) {
  const Rigid3 behind(Eigen::Translation3d(0, 0, -6));
  const SightShares shares = compared(test::scan_from_sides(test::balls_field(), noise), behind);
  EXPECT_LT(shares.in_front, 0.02);
}

TEST(SmoothSight, BesideTheObjectIsVoidWhereTheScannerLooked) {
  test::ScannedShape shape = test::scan_from_sides(test::sphere_field(8, {-15, 0, 0}), 0.1);
  const Rigid3 aside(Eigen::Translation3d(30, 0, 0));
  EXPECT_GT(compared(shape, aside).in_void, 0.3);
  EXPECT_EQ(compared(shape, Rigid3::Identity()).in_void, 0);
  shape.scans[0].grid.reset();
  EXPECT_EQ(compared(shape, aside).in_void, 0) << "without a grid its field of view is not known";
}

TEST(SmoothSight, AGapWithinWhatWasSeenIsNoVoid) {
  test::ScannedShape shape = test::scan_from_sides(test::wavy_field(), 0.1);
  RangeScan& viewer = shape.scans[0];
  std::vector<std::uint8_t> dark(viewer.cloud.size(), 0);  // as a patch that shines or swallows the light
  for (std::size_t i = 0; i < dark.size(); ++i)
    dark[i] = viewer.cloud.positions[i].head<2>().norm() < 9 ? 1 : 0;
  const std::size_t before = viewer.cloud.size();
  viewer = ingest::without_points(std::move(viewer), dark);
  ASSERT_LT(viewer.cloud.size(), before - 50);
  EXPECT_EQ(compared(shape, Rigid3::Identity()).in_void, 0);
}

TEST(SmoothSight, DivergingRaysHaveAFieldOfViewToo) {
  const test::ScannedShape shape = test::scan_from_sides(test::balls_field(), 0.1, true);
  const ScanSurface surface(shape.scans[0], ingest::estimate_normals(shape.scans[0]));
  ASSERT_TRUE(surface.field_of_view().known());
  EXPECT_TRUE(surface.field_of_view().contains(surface.box().center()));
  EXPECT_FALSE(surface.field_of_view().contains(surface.box().center() + Eigen::Vector3d(500, 0, 0)));
  EXPECT_FALSE(FieldOfView(test::without_grid(shape.scans[0])).contains(surface.box().center()));
}

}  // namespace
}  // namespace drape::registration
