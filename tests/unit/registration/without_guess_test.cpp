#include <gtest/gtest.h>

#include <algorithm>

#include "drape/base/parallel.hpp"
#include "drape/registration/register_scans.hpp"
#include "shapes.hpp"

namespace drape::registration {
namespace {

using test::ScannedShape;

// Lumps that no motion brings onto themselves.
test::DistanceField lumps_field() {
  return test::united(test::united(test::balls_field(), test::sphere_field(7, {-12, 14, 9})),
                      [box = test::box_field({16, 5, 4})](const Eigen::Vector3d& p) {
                        return box(p - Eigen::Vector3d(-6, -16, 6));
                      });
}

ScannedShape lumps(double noise, bool diverging = false) {
  return test::turned_anyhow(test::scan_from_sides(lumps_field(), noise, diverging), 4);
}

const std::vector<std::optional<Rigid3>> none(3);

void expect_found(const ScannedShape& shape, const Registration& found, double tolerance) {
  for (const PlacedScan& scan : found.scans) ASSERT_TRUE(scan.placed) << scan.reason;
  EXPECT_LT(test::relative_error(shape, found), tolerance);
}

TEST(WithoutGuess, ScansThatAreTurnedAnyhowAreFound) {
  for (const bool diverging : {false, true})
    for (const double noise : {0.0, 0.1}) {
      const ScannedShape shape = lumps(noise, diverging);
      const Registration found = register_scans(shape.scans, none, {}, {});
      expect_found(shape, found, 0.02 + noise);
      ASSERT_EQ(found.searched.size(), 3U);
      for (const SearchedPair& pair : found.searched) {
        EXPECT_TRUE(pair.accepted) << pair.reason;
        EXPECT_GT(pair.overlap, 0.3);
      }
      EXPECT_EQ(found.scans[0].world_from_scan.matrix(), Rigid3::Identity().matrix());
    }
}

TEST(WithoutGuess, GivenPosesAreKeptUnlessGlobalIsAskedFor) {
  const ScannedShape shape = lumps(0.05);
  auto given = shape.given();
  given[2].reset();
  const Registration kept = register_scans(shape.scans, given, {}, {});
  expect_found(shape, kept, 0.1);
  EXPECT_LT((*given[0] * kept.scans[0].world_from_scan.inverse()).translation().norm(), 0.2);
  EXPECT_EQ(kept.scans[0].reason, "given pose");
  for (const SearchedPair& pair : kept.searched) EXPECT_EQ(pair.second, 2U) << "the others have their poses";
  given[1] = Rigid3::Identity();  // wrong
  expect_found(shape, register_scans(shape.scans, given, {.method = Method::global}, {}), 0.1);
}

TEST(WithoutGuess, TheSameBytesForAnyNumberOfThreads) {
  const ScannedShape shape = lumps(0.1);
  set_thread_count(1);
  const Registration one = register_scans(shape.scans, none, {}, {});
  set_thread_count(4);
  const Registration four = register_scans(shape.scans, none, {}, {});
  set_thread_count(0);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(one.scans[i].world_from_scan.matrix(), four.scans[i].world_from_scan.matrix());
}

TEST(WithoutGuess, AScanOfSomethingElseStaysOut) {
  ScannedShape shape = lumps(0.05);
  shape.scans.push_back(test::scan_field(test::wavy_field(), Rigid3::Identity(), {.noise = 0.05, .seed = 7}));
  shape.scans.back().file = "waves.ply";
  const Registration found = register_scans(shape.scans, std::vector<std::optional<Rigid3>>(4), {}, {});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(found.scans[i].placed) << found.scans[i].reason;
  EXPECT_FALSE(found.scans[3].placed);
  EXPECT_NE(found.scans[3].reason.find("none was found"), std::string::npos) << found.scans[3].reason;
  for (const SearchedPair& pair : found.searched)
    if (pair.second == 3) {
      EXPECT_FALSE(pair.accepted);
      EXPECT_FALSE(pair.reason.empty());
    }
}

TEST(WithoutGuess, TheRestOfAnotherObjectIsToldApart) {
  // Two scans of the one and three of the other: the larger group is placed.
  ScannedShape shape = lumps(0.05);
  const ScannedShape balls = test::turned_anyhow(test::scan_from_sides(test::wavy_field(), 0.05), 9);
  shape.scans.insert(shape.scans.begin(), balls.scans.begin(), balls.scans.begin() + 2);
  const Registration found = register_scans(shape.scans, std::vector<std::optional<Rigid3>>(5), {}, {});
  EXPECT_FALSE(found.scans[0].placed);
  EXPECT_FALSE(found.scans[1].placed);
  for (std::size_t i = 2; i < 5; ++i) EXPECT_TRUE(found.scans[i].placed) << found.scans[i].reason;
  EXPECT_EQ(found.scans[2].world_from_scan.matrix(), Rigid3::Identity().matrix());
  // Only what the final poses rest on is accepted, though the first two fit each other.
  for (const SearchedPair& pair : found.searched)
    if (pair.accepted)
      EXPECT_TRUE(found.scans[pair.first].placed && found.scans[pair.second].placed);
    else
      EXPECT_FALSE(pair.reason.empty());
  EXPECT_NE(found.searched[0].reason.find("not placed in the end"), std::string::npos)
      << found.searched[0].reason;
}

// Scans of an object on a turntable, by one scanner.
ScannedShape turntable(const test::DistanceField& field, int count, double step_deg) {
  ScannedShape shape;
  for (int i = 0; i < count; ++i) {
    const Rigid3 world_from_scan =
        Eigen::Translation3d(2, 1, -3) * test::rotation_deg(-i * step_deg, Eigen::Vector3d::UnitY());
    shape.scans.push_back(
        test::scan_field(field, world_from_scan, {.noise = 0.05, .seed = 40U + static_cast<unsigned>(i)}));
    shape.scans.back().file = "turn" + std::to_string(i) + ".ply";
    shape.world_from_scan.push_back(world_from_scan);
  }
  return shape;
}

TEST(WithoutGuess, ATurntablesStepIsUsed) {
  const ScannedShape shape = turntable(lumps_field(), 3, 25);
  expect_found(shape, register_scans(shape.scans, none, {.turntable_step_deg = 25}, {}), 0.1);
  // A step that is not what happened cannot be borne out.
  const Registration wrong = register_scans(shape.scans, none, {.turntable_step_deg = -100}, {});
  EXPECT_FALSE(wrong.scans[1].placed && wrong.scans[2].placed);
}

TEST(WithoutGuess, OfASequenceOnlyNeighboursAreCompared) {
  const ScannedShape shape = turntable(lumps_field(), 7, 15);
  const Registration found =
      register_scans(shape.scans, std::vector<std::optional<Rigid3>>(7), {.sequence = true}, {});
  EXPECT_EQ(found.searched.size(), 14U);
  expect_found(shape, found, 0.1);
}

}  // namespace
}  // namespace drape::registration
