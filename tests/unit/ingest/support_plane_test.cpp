#include "support_plane.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "analytic_scans.hpp"
#include "drape/ingest/clean_scan.hpp"

namespace drape::ingest {
namespace {

using Eigen::Vector3d;

// A ball of radius 10 that rests on the plane z = -10, seen from above at a slant of 40 degrees.
RangeScan ball_on_table(bool table, const Vector3d& offset = Vector3d::Zero()) {
  const test::DistanceField field = [=](const Vector3d& p) {
    const double ball = (p - offset).norm() - 10;
    return table ? std::min(ball, (p - offset).z() + 10) : ball;
  };
  const Rigid3 slanted = Eigen::Translation3d(offset) *
                         Rigid3(Eigen::AngleAxisd(40 * std::numbers::pi / 180, Vector3d::UnitX()));
  return test::scan_field(field, slanted, {.noise = 0.1, .diverging = true});
}

std::size_t count(const std::vector<std::uint8_t>& flags) {
  return static_cast<std::size_t>(std::count(flags.begin(), flags.end(), std::uint8_t{1}));
}

TEST(SupportPlane, TakesTheTableAndLeavesTheBall) {
  const RangeScan with = ball_on_table(true);
  const std::vector<std::uint8_t> flags = support_plane(with, with.view, 1);
  const Eigen::AngleAxisd slant(40 * std::numbers::pi / 180, Vector3d::UnitX());
  ASSERT_GT(count(flags), 2000U);
  for (std::size_t i = 0; i < flags.size(); ++i) {
    const double height = (slant * with.cloud.positions[i]).z() + 10;
    if (height > 0.8 && height < 1.2) continue;
    EXPECT_EQ(flags[i], height < 1 ? 1 : 0) << height;
  }
}

TEST(SupportPlane, IsNotAFlatSideOfTheObject) {
  // A half ball, its flat side towards the scanner: all the rest lies behind that side.
  const test::DistanceField field = [](const Vector3d& p) { return std::max(p.norm() - 20, p.z()); };
  const RangeScan scan = test::scan_field(
      field, Rigid3(Eigen::AngleAxisd(50 * std::numbers::pi / 180, Vector3d::UnitX())), {.noise = 0.05});
  ASSERT_GT(scan.cloud.size(), 500U);
  EXPECT_EQ(count(support_plane(scan, scan.view, 1)), 0U);
}

TEST(SupportPlane, NeedsAPlaneAndAView) {
  const RangeScan ball = ball_on_table(false);
  EXPECT_EQ(count(support_plane(ball, ball.view, 1)), 0U);
  const RangeScan blind = test::without_view(ball_on_table(true));
  EXPECT_EQ(count(support_plane(blind, blind.view, 1)), 0U);
  RangeScan two;
  two.cloud.positions = {{0, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(count(support_plane(two, ball.view, 1)), 0U);
  two.cloud.positions.assign(50, Vector3d::Ones());
  EXPECT_EQ(count(support_plane(two, ball.view, 1)), 0U);
}

TEST(SupportPlane, IsDroppedByCleaningOnRequest) {
  const RangeScan scan = ball_on_table(true);
  EXPECT_EQ(clean_scan(scan, {}, {}).dropped.count("support_plane"), 0U);
  CleanOptions options;
  options.support_plane = SupportPlane::drop;
  const CleanedScan cleaned = clean_scan(scan, options, {});
  EXPECT_GT(cleaned.dropped.at("support_plane"), 2000U);
  EXPECT_LT(cleaned.scan.cloud.size(), 500U);
  EXPECT_GT(cleaned.scan.cloud.size(), 100U);
  options.support_plane_spacings = 0.1;
  EXPECT_LT(clean_scan(scan, options, {}).dropped.at("support_plane"), cleaned.dropped.at("support_plane"));
}

TEST(SupportPlane, IsFoundFarFromTheOrigin) {
  // Coordinates of a survey, as large as no float could hold them.
  const Vector3d far(4.5e6, 5.2e6, 300);
  RangeScan scan = ball_on_table(true);
  const std::size_t near_count = count(support_plane(scan, scan.view, 1));
  for (Vector3d& point : scan.cloud.positions) point += far;
  scan.view.vector += far;
  EXPECT_EQ(count(support_plane(scan, scan.view, 1)), near_count);
}

}  // namespace
}  // namespace drape::ingest
