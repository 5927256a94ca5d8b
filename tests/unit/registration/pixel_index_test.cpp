#include "pixel_index.hpp"

#include <gtest/gtest.h>

#include "scan_surface.hpp"
#include "shapes.hpp"

namespace drape::registration {
namespace {

TEST(PixelIndex, FindsWhatLiesWhereAPointIsSeen) {
  for (const bool diverging : {false, true}) {
    const test::ScannedShape shape = test::scan_from_sides(test::balls_field(), 0.02, diverging);
    const RangeScan& scan = shape.scans[0];
    const auto& points = scan.cloud.positions;
    const PixelIndex pixels(scan.view, points, scan.spacing);
    std::size_t found = 0;
    std::size_t asked = 0;
    for (std::size_t i = 0; i < points.size(); i += 11, ++asked) {
      const Eigen::Vector3d query = points[i] + 0.1 * scan.spacing * Eigen::Vector3d(1, -1, 0.5);
      const auto nearest = pixels.nearest(query);
      if (!nearest) continue;
      ++found;
      EXPECT_NEAR(nearest->squared_distance, (points[nearest->index] - query).squaredNorm(), 1e-12);
      EXPECT_LT(std::sqrt(nearest->squared_distance), 3 * scan.spacing);
    }
    EXPECT_GT(found, asked * 9 / 10) << "all but those at the rim of the picture";
  }
}

TEST(PixelIndex, FindsNothingOutOfSight) {
  const RangeScan scan = test::scan_from_sides(test::balls_field(), 0).scans[0];
  const auto& points = scan.cloud.positions;
  EXPECT_FALSE(PixelIndex(scan.view, points, scan.spacing).nearest(Eigen::Vector3d(1e4, 1e4, 1e4)));
  EXPECT_FALSE(PixelIndex({}, points, scan.spacing).nearest(points[0])) << "the view is unknown";
  EXPECT_FALSE(PixelIndex(scan.view, {}, scan.spacing).nearest(points[0])) << "there are no points";
}

}  // namespace
}  // namespace drape::registration
