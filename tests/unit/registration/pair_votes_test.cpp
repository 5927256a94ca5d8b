#include "pair_votes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "drape/ingest/estimate_normals.hpp"
#include "scan_surface.hpp"
#include "shapes.hpp"

namespace drape::registration {
namespace {

CoarseScan coarse(const RangeScan& scan, double voxel) {
  const std::vector<Eigen::Vector3f> normals = ingest::estimate_normals(scan);
  return CoarseScan(ScanSurface(scan, normals), voxel);
}

// How far the first of the guesses puts the middle of the scan off, and how much it turns it off.
struct Off {
  double shift;
  double degrees;
};
Off first_off(const std::vector<MotionGuess>& guesses, const Rigid3& truth, const CoarseScan& scan) {
  const Rigid3& found = guesses.at(0).target_from_source;
  const Eigen::Vector3d& p = scan.points()[scan.size() / 2];
  return {(found * p - truth * p).norm(),
          Eigen::AngleAxisd(truth.linear().transpose() * found.linear()).angle() * 180 / std::numbers::pi};
}

TEST(VotedMotions, TheRightOneHasMostVotesInHeavyNoise) {
  // A tenth of the smallest ball's radius: the surroundings of single points are drowned in it.
  const test::ScannedShape shape = test::turned_anyhow(test::scan_from_sides(test::balls_field(), 0.9), 3);
  const double voxel = 1.6;
  const CoarseScan source = coarse(shape.scans[1], voxel);
  const CoarseScan target = coarse(shape.scans[0], voxel);
  const Rigid3 truth = shape.world_from_scan[0].inverse() * shape.world_from_scan[1];
  const std::vector<MotionGuess> guesses = voted_motions(source, target, 10);
  ASSERT_FALSE(guesses.empty());
  EXPECT_LE(guesses.size(), 10U);
  const Off off = first_off(guesses, truth, source);
  EXPECT_LT(off.shift, 4 * voxel) << "what counts as the same motion";
  EXPECT_LT(off.degrees, 12) << "the width of a bin";
  for (std::size_t i = 1; i < guesses.size(); ++i) EXPECT_LE(guesses[i].agreeing, guesses[i - 1].agreeing);
}

TEST(VotedMotions, CoordinatesFarFromTheOriginDoNotMatter) {
  test::ScannedShape shape = test::scan_from_sides(test::balls_field(), 0.1);
  const Rigid3 far(Eigen::Translation3d(5e6, -3e6, 400));
  for (auto& p : shape.scans[1].cloud.positions) p = far * p;
  shape.scans[1].view.vector = shape.scans[1].view.kind == ScanView::Kind::origin
                                   ? Eigen::Vector3d(far * shape.scans[1].view.vector)
                                   : shape.scans[1].view.vector;
  const CoarseScan source = coarse(shape.scans[1], 1.6);
  const CoarseScan target = coarse(shape.scans[0], 1.6);
  const Rigid3 truth = shape.world_from_scan[0].inverse() * shape.world_from_scan[1] * far.inverse();
  const Off off = first_off(voted_motions(source, target, 1), truth, source);
  EXPECT_LT(off.shift, 4 * 1.6);
  EXPECT_LT(off.degrees, 12);
}

TEST(VotedMotions, FewPointsGiveNone) {
  RangeScan scan;
  scan.cloud.positions = {Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()};
  scan.cloud.normals.assign(3, Eigen::Vector3f::UnitZ());
  const CoarseScan few = coarse(scan, 0.5);
  EXPECT_TRUE(voted_motions(few, few, 5).empty()) << "none is far enough from the others";
}

}  // namespace
}  // namespace drape::registration
