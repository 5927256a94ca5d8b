// Scans that slide on each other along what they share, and what holds them all the same.
#include <gtest/gtest.h>

#include "drape/ingest/estimate_normals.hpp"
#include "kept_points.hpp"
#include "pair_pose.hpp"
#include "shapes.hpp"
#include "sliding.hpp"

namespace drape::registration {
namespace {

constexpr double voxel = 1;
constexpr double noise = 0.1;
constexpr double half_length = 16;

// A profile in x and z that no motion brings onto itself, drawn out along y.
test::DistanceField extruded_field() {
  const auto block = [box = test::box_field({3, half_length, 8})](const Eigen::Vector3d& p) {
    return box(p - Eigen::Vector3d(-9, 0, 2));
  };
  const auto profile =
      test::united(test::united(block, test::sphere_field(8, {2, 0, 0})), test::sphere_field(4, {12, 0, -2}));
  return [profile](const Eigen::Vector3d& p) {
    const double across = profile({p.x(), 0, p.z()});
    const double along = std::abs(p.y()) - half_length;
    return std::min(std::max(across, along), 0.0) + std::hypot(std::max(across, 0.0), std::max(along, 0.0));
  };
}

// A body of rotation about y.
test::DistanceField round_field() {
  return [](const Eigen::Vector3d& p) {
    const double waist = 8 + 2 * std::cos(p.y() / 5);
    const double across = 0.8 * (std::hypot(p.x(), p.z()) - waist);
    return std::max(across, std::abs(p.y()) - half_length);
  };
}

test::ScannedShape scanned(const test::DistanceField& field, const Eigen::Vector3d& tilt_axis) {
  test::ScannedShape shape;
  for (const double degrees : {-35.0, 35.0}) {
    const Rigid3 pose = test::rotation_deg(degrees, tilt_axis);
    shape.scans.push_back(test::scan_field(
        field, pose,
        {.rows = 100, .columns = 100, .pitch = 0.5, .noise = noise, .seed = shape.scans.size() + 1}));
    shape.world_from_scan.push_back(pose);
  }
  return shape;
}

// The first sees the end at +y, the second the one at -y.
test::ScannedShape from_both_ends(const test::DistanceField& field) {
  return scanned(field, Eigen::Vector3d::UnitX());
}

// Neither sees an end.
test::ScannedShape from_the_sides(const test::DistanceField& field) {
  return scanned(field, Eigen::Vector3d::UnitY());
}

struct Pair {
  explicit Pair(const test::ScannedShape& shape)
      : first(shape.scans[0], ingest::estimate_normals(shape.scans[0])),
        second(shape.scans[1], ingest::estimate_normals(shape.scans[1])),
        target(first, voxel),
        source(second, voxel),
        world_from_target(shape.world_from_scan[0]),
        target_from_source(shape.world_from_scan[0].inverse() * shape.world_from_scan[1]) {}

  // With the second scan moved in the world.
  [[nodiscard]] Rigid3 moved(const Rigid3& motion) const {
    return world_from_target.inverse() * motion * world_from_target * target_from_source;
  }
  [[nodiscard]] double off(const Rigid3& pose) const {
    double sum = 0;
    for (const auto& p : second.points()) sum += (pose * p - target_from_source * p).norm();
    return sum / static_cast<double>(second.size());
  }

  ScanSurface first;
  ScanSurface second;
  SearchedScan target;
  SearchedScan source;
  Rigid3 world_from_target;
  Rigid3 target_from_source;
};

TEST(Slide, AnExtrudedBodyIsHeldByItsEnds) {
  const Pair pair(from_the_sides(extruded_field()));
  for (const double along : {-2.5 * voxel, 0.0, 2.5 * voxel}) {
    const Rigid3 start = pair.moved(Rigid3(Eigen::Translation3d(0, along, 0)));
    const PairPose judged = judge_pair(pair.source, pair.target, start);
    ASSERT_TRUE(judged.slides()) << judged.hold;
    EXPECT_FALSE(judged.against.empty());
    const auto slide = slide_to_middle(pair.source, pair.target, start);
    ASSERT_TRUE(slide) << along;
    EXPECT_LT(pair.off(slide->target_from_source), 0.5 * voxel) << along;
    EXPECT_LT(slide->play_voxels, 2);
    const PairPose held = judge_pair(pair.source, pair.target, slide->target_from_source, 1, true);
    EXPECT_EQ(held.against, "");
    EXPECT_GT(held.score(), 0);
  }
}

TEST(Slide, NothingHoldsABodyOfRotation) {
  const Pair pair(from_both_ends(round_field()));
  ASSERT_TRUE(judge_pair(pair.source, pair.target, pair.target_from_source).slides());
  EXPECT_FALSE(slide_to_middle(pair.source, pair.target, pair.target_from_source));
}

TEST(Slide, EndsTellNothingWhereTheScannersFieldOfViewIsUnknown) {
  test::ScannedShape shape = from_the_sides(extruded_field());
  {
    const Pair pair(shape);
    EXPECT_TRUE(slide_to_middle(pair.source, pair.target, pair.target_from_source));
  }
  for (RangeScan& scan : shape.scans) scan = test::without_grid(std::move(scan));
  const Pair pair(shape);
  EXPECT_FALSE(slide_to_middle(pair.source, pair.target, pair.target_from_source));
}

TEST(Slide, WhatContradictsEvenInTheMiddleIsNotHeld) {
  const Pair pair(from_both_ends(extruded_field()));
  const Rigid3 turned = pair.moved(test::rotation_deg(180, Eigen::Vector3d::UnitZ()));
  EXPECT_FALSE(slide_to_middle(pair.source, pair.target, turned));
}

TEST(Slide, AnExtrudedBodyIsRegisteredWithoutAGuess) {
  const test::ScannedShape shape = test::turned_anyhow(from_both_ends(extruded_field()), 5);
  const Registration found = register_scans(shape.scans, std::vector<std::optional<Rigid3>>(2), {}, {});
  ASSERT_TRUE(found.scans[1].placed) << found.scans[1].reason;
  EXPECT_LT(test::relative_error(shape, found), 0.02 * 2 * half_length);
}

TEST(Outline, OnlyTheVoidThatWasLookedAtTellsThatAPointWasMissed) {
  test::ScannedShape shape = from_both_ends(extruded_field());
  RangeScan& scan = shape.scans[0];
  const Eigen::Vector3d towards = Eigen::Vector3d::UnitZ();
  const auto missed = [&](const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
    const ScanSurface surface(scan, ingest::estimate_normals(scan));
    return Outline(surface).missed(point, normal);
  };
  const Eigen::Vector3d beside(0, 21, 0);
  EXPECT_TRUE(missed(beside, towards));
  EXPECT_FALSE(missed(beside, -towards)) << "it faces away";
  EXPECT_FALSE(missed({0, 35, 0}, towards)) << "nobody looked there";
  EXPECT_FALSE(missed({0, 0, 0}, towards)) << "something was seen there";
  std::vector<std::uint8_t> dark(scan.cloud.size(), 0);
  for (std::size_t i = 0; i < dark.size(); ++i)
    dark[i] = scan.cloud.positions[i].head<2>().norm() < 6 ? 1 : 0;
  scan = ingest::without_points(std::move(scan), dark);
  EXPECT_FALSE(missed({0, 0, 0}, towards)) << "a gap within what was seen";
  scan = test::without_grid(std::move(scan));
  EXPECT_FALSE(missed(beside, towards));
}

}  // namespace
}  // namespace drape::registration
