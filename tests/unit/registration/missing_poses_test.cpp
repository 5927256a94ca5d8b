#include <gtest/gtest.h>

#include <cmath>

#include "drape/registration/register_scans.hpp"
#include "shapes.hpp"

namespace drape::registration {
namespace {

using test::ScannedShape;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(MissingPoses, AScanIsPlacedByItsOverlap) {
  const ScannedShape shape = test::scan_from_sides(test::balls_field(), 0.05);
  auto given = shape.given();
  given[1].reset();  // 25 degrees away from its neighbours
  const Registration found = register_scans(shape.scans, given, {}, {});
  ASSERT_TRUE(found.scans[1].placed) << found.scans[1].reason;
  EXPECT_TRUE(contains(found.scans[1].reason, "found by fitting")) << found.scans[1].reason;
  EXPECT_LT(test::relative_error(shape, found), 0.05);
}

TEST(MissingPoses, OnlyTheSearchPlacesThem) {
  const ScannedShape shape = test::scan_from_sides(test::balls_field(), 0.05);
  auto given = shape.given();
  given[1].reset();
  const Registration found = register_scans(shape.scans, given, {.method = Method::given}, {});
  EXPECT_FALSE(found.scans[1].placed);
  EXPECT_EQ(found.scans[1].reason, "no pose was given");
  EXPECT_EQ(found.merged.size(), shape.scans[0].cloud.size() + shape.scans[2].cloud.size());
}

TEST(MissingPoses, WithoutAnyTheFirstScanIsTheWorld) {
  const ScannedShape shape = test::scan_from_sides(test::balls_field(), 0.05);
  const std::vector<std::optional<Rigid3>> none(3);
  const Registration found = register_scans(shape.scans, none, {}, {});
  EXPECT_LT((found.scans[0].world_from_scan.matrix() - Rigid3::Identity().matrix()).norm(), 1e-9);
  for (const PlacedScan& scan : found.scans) ASSERT_TRUE(scan.placed) << scan.reason;
  EXPECT_LT(test::relative_error(shape, found), 0.05);
}

TEST(MissingPoses, ThePoseThatAScanStatesItselfCounts) {
  ScannedShape shape = test::scan_from_sides(test::balls_field(), 0.05);
  auto given = shape.given();
  shape.scans[1].world_from_scan = given[1];
  given[1].reset();
  const Registration found = register_scans(shape.scans, given, {.method = Method::given}, {});
  EXPECT_TRUE(found.scans[1].placed);
  EXPECT_EQ(found.scans[1].world_from_scan.matrix(), shape.world_from_scan[1].matrix());
}

// A scan of the waves and one of something else.
Registration waves_and(const RangeScan& other, const RegisterOptions& options) {
  const std::vector<RangeScan> scans{
      test::scan_field(test::wavy_field(), Rigid3::Identity(), {.noise = 0.05}), other};
  return register_scans(scans, std::vector<std::optional<Rigid3>>{Rigid3::Identity(), std::nullopt}, options,
                        {});
}

TEST(MissingPoses, AnotherObjectIsNotForcedIn) {
  const Registration found =
      waves_and(test::scan_field(test::balls_field(), Rigid3::Identity(), {.noise = 0.05, .seed = 9}), {});
  EXPECT_FALSE(found.scans[1].placed);
  EXPECT_TRUE(contains(found.scans[1].reason, "no pose was given, and none was found"))
      << found.scans[1].reason;
  EXPECT_EQ(found.merged.size(), 3600U);
}

TEST(MissingPoses, WhatTheOtherScanLookedThroughIsNoPlace) {
  // The same waves, but with a pillar on them that the first scan did not see: right overlap, wrong object.
  // No two waves are as long: shifted by one, the pillar would stand beside what the first scan saw.
  const test::DistanceField waves = [](const Eigen::Vector3d& p) {
    const double x = p.x() + 0.008 * p.x() * p.x();
    const double y = p.y() - 0.007 * p.y() * p.y();
    return 0.5 * (p.z() - 4 * std::sin(x / 7) - 3 * std::cos(y / 6 + 0.5));
  };
  const auto pillar = [box = test::box_field({6, 6, 30})](const Eigen::Vector3d& p) {
    return box(p - Eigen::Vector3d(10, 5, 20));
  };
  for (const bool diverging : {false, true}) {
    const test::LatticeSetup setup{.noise = 0.05, .diverging = diverging};
    const std::vector<RangeScan> scans{
        test::scan_field(waves, Rigid3::Identity(), setup),
        test::scan_field(test::united(waves, pillar), Rigid3::Identity(), setup)};
    const Registration found =
        register_scans(scans, std::vector<std::optional<Rigid3>>{Rigid3::Identity(), std::nullopt}, {}, {});
    EXPECT_FALSE(found.scans[1].placed);
    EXPECT_TRUE(contains(found.scans[1].reason, "looked through")) << found.scans[1].reason;
    // Without the pillar they lie on each other.
    const std::vector<RangeScan> same{scans[0], test::scan_field(waves, Rigid3::Identity(), setup)};
    EXPECT_TRUE(
        register_scans(same, std::vector<std::optional<Rigid3>>{Rigid3::Identity(), std::nullopt}, {}, {})
            .scans[1]
            .placed);
  }
}

}  // namespace
}  // namespace drape::registration
