#include <gtest/gtest.h>

#include "drape/registration/register_scans.hpp"
#include "shapes.hpp"

namespace drape::registration {
namespace {

using test::ScannedShape;

// The three scans of the waves with one more, in the place that `pose` says.
Registration with_a_fourth(const RangeScan& fourth, const std::optional<Rigid3>& pose) {
  ScannedShape shape = test::scan_from_sides(test::wavy_field(), 0.05);
  auto given = shape.given();
  shape.scans.push_back(fourth);
  given.push_back(pose);
  return register_scans(shape.scans, given, {}, {});
}

void expect_the_others_unharmed(const Registration& found) {
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(found.scans[i].placed);
    EXPECT_LT(found.scans[i].moved_m, 0.05);
  }
  for (const auto& p : found.merged.positions) EXPECT_TRUE(p.allFinite());
  for (const auto& n : found.merged.normals) EXPECT_NEAR(n.norm(), 1.0F, 1e-4F);
}

TEST(OddScans, NoScans) {
  const Registration found = register_scans({}, {}, {}, {});
  EXPECT_TRUE(found.scans.empty());
  EXPECT_TRUE(found.merged.empty());
}

TEST(OddScans, OneScanStaysWhereItIs) {
  const std::vector<RangeScan> scan{test::scan_field(test::balls_field(), Rigid3::Identity(), {})};
  const Rigid3 pose = Eigen::Translation3d(3, 4, 5) * test::rotation_deg(30, {0, 1, 1});
  const Registration given = register_scans(scan, std::vector<std::optional<Rigid3>>{pose}, {}, {});
  EXPECT_EQ(given.scans[0].world_from_scan.matrix(), pose.matrix());
  EXPECT_EQ(given.merged.positions[0], pose * scan[0].cloud.positions[0]);
  EXPECT_TRUE(given.converged);
  const Registration free = register_scans(scan, std::vector<std::optional<Rigid3>>(1), {}, {});
  EXPECT_TRUE(free.scans[0].placed);
  EXPECT_EQ(free.scans[0].world_from_scan.matrix(), Rigid3::Identity().matrix());
}

TEST(OddScans, AnEmptyScanIsNotPlaced) {
  for (const auto& pose : {std::optional<Rigid3>(Rigid3::Identity()), std::optional<Rigid3>()}) {
    const Registration found = with_a_fourth(RangeScan{}, pose);
    EXPECT_FALSE(found.scans[3].placed);
    EXPECT_EQ(found.scans[3].reason, "it has no points");
    expect_the_others_unharmed(found);
  }
}

TEST(OddScans, OnlyEmptyScans) {
  const Registration found =
      register_scans(std::vector<RangeScan>(2), std::vector<std::optional<Rigid3>>(2), {}, {});
  for (const PlacedScan& scan : found.scans) EXPECT_FALSE(scan.placed);
  EXPECT_TRUE(found.merged.empty());
}

TEST(OddScans, ScansThatSpanNoSurfaceStayAsGivenOrOut) {
  RangeScan three;
  three.cloud.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  RangeScan same;
  same.cloud.positions.assign(500, {1, 2, 3});
  RangeScan line;
  for (int i = 0; i < 500; ++i) line.cloud.positions.emplace_back(0.1 * i, 0.2 * i, 0);
  const Rigid3 pose(Eigen::Translation3d(0, 0, 2));
  for (const RangeScan& odd : {three, same, line}) {
    const Registration given = with_a_fourth(odd, pose);
    EXPECT_TRUE(given.scans[3].placed);
    EXPECT_EQ(given.scans[3].world_from_scan.matrix(), pose.matrix());
    EXPECT_TRUE(given.scans[3].reason.find("overlaps no other scan") != std::string::npos);
    expect_the_others_unharmed(given);
    const Registration free = with_a_fourth(odd, std::nullopt);
    EXPECT_FALSE(free.scans[3].placed);
    EXPECT_TRUE(free.scans[3].reason.find("do not span a surface") != std::string::npos)
        << free.scans[3].reason;
    expect_the_others_unharmed(free);
  }
}

TEST(OddScans, WithoutNormalsTheyAreEstimated) {
  ScannedShape shape = test::scan_from_sides(test::balls_field(), 0.05);
  for (RangeScan& scan : shape.scans) scan = test::without_grid(scan);
  auto given = shape.given();
  given[0] = test::perturbed(*given[0], 2, 1, 3);
  const Registration found = register_scans(shape.scans, given, {}, {});
  EXPECT_LT(test::relative_error(shape, found), 0.05);
  ASSERT_EQ(found.merged.normals.size(), found.merged.size());
}

TEST(OddScans, DisjointScansStayAsGiven) {
  const Rigid3 far(Eigen::Translation3d(1000, 0, 0));
  const Registration found = with_a_fourth(test::scan_field(test::wavy_field(), Rigid3::Identity(), {}), far);
  EXPECT_TRUE(found.scans[3].placed);
  EXPECT_EQ(found.scans[3].world_from_scan.matrix(), far.matrix());
  EXPECT_EQ(found.scans[3].overlap, 0.0);
  EXPECT_EQ(found.scans[3].rms_m, 0.0);
  EXPECT_EQ(found.scans[3].reason, "given pose; it overlaps no other scan");
  expect_the_others_unharmed(found);
}

TEST(OddScans, AMirroredOrWildPoseDoesNotBreakTheOthers) {
  const Rigid3 inside_out = test::rotation_deg(180, Eigen::Vector3d::UnitX());
  const Registration found =
      with_a_fourth(test::scan_field(test::wavy_field(), Rigid3::Identity(), {}), inside_out);
  expect_the_others_unharmed(found);
}

}  // namespace
}  // namespace drape::registration
