#include "patch_misfit.hpp"

#include <gtest/gtest.h>

#include "drape/ingest/estimate_normals.hpp"
#include "shapes.hpp"

namespace drape::registration {
namespace {

constexpr double voxel = 1.6;

struct Scanned {
  explicit Scanned(const RangeScan& scan)
      : surface(scan, ingest::estimate_normals(scan)), coarse(surface, voxel) {}
  Scanned(const Scanned&) = delete;
  Scanned& operator=(const Scanned&) = delete;

  ScanSurface surface;
  CoarseScan coarse;
};

// Of the second side of one field on the first side of another.
double misfit(const test::DistanceField& first, const test::DistanceField& second, double noise) {
  const test::ScannedShape one = test::scan_from_sides(first, noise);
  const test::ScannedShape other = test::scan_from_sides(second, noise);
  const Scanned target(one.scans[0]);
  const Scanned source(other.scans[1]);
  return patch_misfit(source.surface, source.coarse, target.surface, target.coarse,
                      one.world_from_scan[0].inverse() * one.world_from_scan[1]);
}

TEST(PatchMisfit, NoiseAloneKeepsARightPairApart) {
  EXPECT_LT(misfit(test::wavy_field(), test::wavy_field(), 0.4), 3);
  EXPECT_GT(misfit(test::wavy_field(), test::wavy_field(), 0.4), 0.5);
}

TEST(PatchMisfit, SurfacesThatAreOnlyAlikeShow) {
  // Apart by less than the noise of single points, but by all of the points of a patch.
  const test::DistanceField deeper = [](const Eigen::Vector3d& p) {
    return test::wavy_field()(p) - 0.18 * std::sin(p.x() / 5) * std::cos(p.y() / 5);
  };
  EXPECT_GT(misfit(test::wavy_field(), deeper, 0.4),
            1.5 * misfit(test::wavy_field(), test::wavy_field(), 0.4));
}

TEST(PatchMisfit, SaysNothingWithoutNoise) {
  EXPECT_EQ(misfit(test::wavy_field(), test::balls_field(), 0.001), 0);
}

}  // namespace
}  // namespace drape::registration
