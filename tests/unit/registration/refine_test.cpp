#include <gtest/gtest.h>

#include "drape/base/parallel.hpp"
#include "drape/registration/register_scans.hpp"
#include "shapes.hpp"

namespace drape::registration {
namespace {

using test::ScannedShape;

std::vector<std::optional<Rigid3>> perturbed(const ScannedShape& shape, double degrees, double shift) {
  auto given = shape.given();
  for (std::size_t i = 0; i < given.size(); ++i)
    given[i] = test::perturbed(*given[i], degrees, shift, 20 + i);
  return given;
}

struct Case {
  const char* name;
  test::DistanceField field;
};
std::vector<Case> shapes() {
  return {{"waves", test::wavy_field()},
          {"balls", test::balls_field()},
          {"box corner", [box = test::box_field({20, 20, 20}), turn = test::rotation_deg(50, {1, 0.6, 0.1})](
                             const Eigen::Vector3d& p) { return box(turn * p); }}};
}

TEST(Refine, BringsPerturbedScansBackWithinTheNoise) {
  for (const Case& shape_case : shapes())
    for (const bool diverging : {false, true}) {
      const double noise = 0.1;
      const ScannedShape shape = test::scan_from_sides(shape_case.field, noise, diverging);
      const auto given = perturbed(shape, 2, 2);
      const Registration start = register_scans(shape.scans, given, {.method = Method::given}, {});
      const Registration found = register_scans(shape.scans, given, {}, {});
      EXPECT_GT(test::relative_error(shape, start), 1.5) << shape_case.name;
      // A thousand matches a pair average the noise away (to 0.005); the rest is what facets and rounded
      // edges leave, worst at the corner of the box.
      EXPECT_LT(test::relative_error(shape, found), 0.7 * noise)
          << shape_case.name << (diverging ? ", diverging" : "");
      EXPECT_TRUE(found.converged) << shape_case.name;
      for (const PlacedScan& scan : found.scans) {
        EXPECT_TRUE(scan.placed);
        EXPECT_GT(scan.moved_m, 0.5);
      }
    }
}

TEST(Refine, WithoutNoiseIsNearlyExact) {
  for (const Case& shape_case : shapes()) {
    const ScannedShape shape = test::scan_from_sides(shape_case.field, 0);
    const Registration found = register_scans(shape.scans, perturbed(shape, 2, 2), {}, {});
    EXPECT_LT(test::relative_error(shape, found), 0.02) << shape_case.name;
  }
}

TEST(Refine, LeavesRightPosesAlone) {
  const ScannedShape shape = test::scan_from_sides(test::wavy_field(), 0.1);
  const Registration found = register_scans(shape.scans, shape.given(), {}, {});
  for (const PlacedScan& scan : found.scans) EXPECT_LT(scan.moved_m, 0.05);
}

TEST(Refine, KeepsTheMeanOfThePoses) {
  const ScannedShape shape = test::scan_from_sides(test::wavy_field(), 0.02);
  auto given = shape.given();
  given[2] = Eigen::Translation3d(0, 0, 3) * *given[2];
  const Registration found = register_scans(shape.scans, given, {}, {});
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < 3; ++i)
    mean += (found.scans[i].world_from_scan.translation() - given[i]->translation()) / 3;
  EXPECT_LT(mean.norm(), 0.1) << "2 of 3 move up by 1, the third down by 2";
  EXPECT_NEAR(found.scans[2].moved_m, 2.0, 0.2);
}

TEST(Refine, MovesWithTheWorld) {
  const ScannedShape shape = test::scan_from_sides(test::balls_field(), 0.1);
  const auto given = perturbed(shape, 2, 1);
  const Rigid3 motion = Eigen::Translation3d(500, -300, 80) * test::rotation_deg(130, {1, -2, 0.5});
  auto moved = given;
  for (auto& pose : moved) pose = motion * *pose;
  const Registration here = register_scans(shape.scans, given, {}, {});
  const Registration there = register_scans(shape.scans, moved, {}, {});
  for (std::size_t i = 0; i < here.scans.size(); ++i) {
    const Rigid3 back = motion.inverse() * there.scans[i].world_from_scan;
    EXPECT_LT((back.matrix() - here.scans[i].world_from_scan.matrix()).norm(), 0.01);
    EXPECT_NEAR(here.scans[i].rms_m, there.scans[i].rms_m, 1e-3);
  }
}

TEST(Refine, GivesTheSameBytesForAnyNumberOfThreads) {
  const ScannedShape shape = test::scan_from_sides(test::balls_field(), 0.1);
  auto given = perturbed(shape, 2, 2);
  given[1].reset();
  set_thread_count(1);
  const Registration one = register_scans(shape.scans, given, {}, {});
  set_thread_count(4);
  const Registration four = register_scans(shape.scans, given, {}, {});
  set_thread_count(0);
  for (std::size_t i = 0; i < one.scans.size(); ++i) {
    EXPECT_EQ(one.scans[i].world_from_scan.matrix(), four.scans[i].world_from_scan.matrix());
    EXPECT_EQ(one.scans[i].rms_m, four.scans[i].rms_m);
    EXPECT_EQ(one.scans[i].reason, four.scans[i].reason);
  }
  EXPECT_EQ(one.merged.positions, four.merged.positions);
  EXPECT_EQ(one.merged.normals, four.merged.normals);
}

TEST(Refine, SlidesNoPlaneAlongAnother) {
  ScannedShape shape;
  for (const std::uint64_t seed : {1, 2}) {
    shape.scans.push_back(
        test::scan_field(test::box_field({200, 200, 5}), Rigid3::Identity(), {.noise = 0.05, .seed = seed}));
    shape.world_from_scan.push_back(Rigid3::Identity());
  }
  const auto given =
      std::vector<std::optional<Rigid3>>{Rigid3::Identity(), Rigid3(Eigen::Translation3d(3, -2, 2))};
  const Registration found = register_scans(shape.scans, given, {}, {});
  const Eigen::Vector3d apart =
      found.scans[1].world_from_scan.translation() - found.scans[0].world_from_scan.translation();
  EXPECT_NEAR(apart.z(), 0, 0.02) << "the gap closes";
  EXPECT_NEAR(apart.x(), 3, 0.3) << "and nothing tells how far they are aside";
  EXPECT_NEAR(apart.y(), -2, 0.3);
}

TEST(Refine, MeasuresDistanceAndOverlap) {
  // Two scans of one wall, the second half beside the first.
  const double noise = 0.05;
  const auto wall = test::box_field({200, 200, 5});
  const Rigid3 beside(Eigen::Translation3d(30, 0, 0));
  const std::vector<RangeScan> scans{test::scan_field(wall, Rigid3::Identity(), {.noise = noise, .seed = 1}),
                                     test::scan_field(wall, beside, {.noise = noise, .seed = 2})};
  const Registration found = register_scans(
      scans, std::vector<std::optional<Rigid3>>{Rigid3::Identity(), beside}, {.method = Method::given}, {});
  for (const PlacedScan& scan : found.scans) {
    // 30 of 60 columns, and the one beside them: it lies within 1.5 spacings.
    EXPECT_NEAR(scan.overlap, 31.0 / 60, 0.01);
    EXPECT_NEAR(scan.rms_m, noise * std::sqrt(2.0), 0.15 * noise);
  }
  ASSERT_EQ(found.pairs.size(), 1U);
  EXPECT_EQ(found.pairs[0].first, 0U);
  EXPECT_EQ(found.pairs[0].second, 1U);
  EXPECT_NEAR(found.pairs[0].overlap, 31.0 / 60, 0.01);
  EXPECT_NEAR(found.pairs[0].rms_m, noise * std::sqrt(2.0), 0.15 * noise);
  EXPECT_EQ(found.pairs[0].rms_m, found.pairs[0].rms_before_m);
}

TEST(Refine, ImprovesThePairsItMeasures) {
  const ScannedShape shape = test::scan_from_sides(test::wavy_field(), 0.1);
  const Registration found = register_scans(shape.scans, perturbed(shape, 1, 1), {}, {});
  ASSERT_EQ(found.pairs.size(), 3U);
  for (const PairQuality& pair : found.pairs) {
    EXPECT_LT(pair.rms_m, 0.2);
    EXPECT_GT(pair.rms_before_m, 2 * pair.rms_m);
  }
}

TEST(Refine, OppositeSidesOfAThinSheetAreNotDrawnTogether) {
  const auto sheet = test::box_field({25, 25, 0.5});
  const Rigid3 from_below = test::rotation_deg(180, Eigen::Vector3d::UnitX());
  const std::vector<RangeScan> scans{test::scan_field(sheet, Rigid3::Identity(), {.noise = 0.02, .seed = 1}),
                                     test::scan_field(sheet, from_below, {.noise = 0.02, .seed = 2})};
  const Registration found =
      register_scans(scans, std::vector<std::optional<Rigid3>>{Rigid3::Identity(), from_below}, {}, {});
  for (const PlacedScan& scan : found.scans) {
    EXPECT_EQ(scan.overlap, 0.0);
    EXPECT_EQ(scan.moved_m, 0.0);
  }
}

TEST(Refine, MaxDistanceSaysFromHowFarSurfacesAreDrawnTogether) {
  const ScannedShape shape = test::scan_from_sides(test::wavy_field(), 0.02);
  auto given = shape.given();
  given[0] = Eigen::Translation3d(0, 0, 9) * *given[0];
  const Registration far = register_scans(shape.scans, given, {.max_distance_spacings = 16}, {});
  EXPECT_LT(test::relative_error(shape, far), 0.1);
  const Registration near = register_scans(shape.scans, given, {.max_distance_spacings = 2}, {});
  EXPECT_GT(test::relative_error(shape, near), 5.0);
}

TEST(Refine, IterationsRunOut) {
  const ScannedShape shape = test::scan_from_sides(test::wavy_field(), 0.02);
  const Registration found = register_scans(shape.scans, perturbed(shape, 2, 2), {.iterations = 1}, {});
  EXPECT_FALSE(found.converged);
  EXPECT_EQ(found.iterations, 1);
}

TEST(Refine, GivenPosesStayWithMethodGiven) {
  const ScannedShape shape = test::scan_from_sides(test::wavy_field(), 0.1);
  const auto given = perturbed(shape, 2, 2);
  const Registration found = register_scans(shape.scans, given, {.method = Method::given}, {});
  for (std::size_t i = 0; i < given.size(); ++i) {
    EXPECT_EQ(found.scans[i].world_from_scan.matrix(), given[i]->matrix());
    EXPECT_EQ(found.scans[i].reason, "given pose");
  }
}

}  // namespace
}  // namespace drape::registration
