#include "pixel_index.hpp"

#include <gtest/gtest.h>

#include "drape/ingest/point_spacing.hpp"
#include "shapes.hpp"

namespace drape::registration {
namespace {

TEST(PixelIndex, FindsWhatLiesWhereAPointIsSeen) {
  for (const bool diverging : {false, true}) {
    const test::ScannedShape shape = test::scan_from_sides(test::balls_field(), 0.02, diverging);
    const RangeScan& scan = shape.scans[0];
    const auto& points = scan.cloud.positions;
    const double spacing = ingest::point_spacing(scan);
    const PixelIndex pixels(scan.view, points, spacing);
    std::size_t found = 0;
    std::size_t close = 0;
    std::size_t asked = 0;
    for (std::size_t i = 0; i < points.size(); i += 11, ++asked) {
      const Eigen::Vector3d query = points[i] + 0.1 * spacing * Eigen::Vector3d(1, -1, 0.5);
      const auto nearest = pixels.nearest(query);
      if (!nearest) continue;
      ++found;
      EXPECT_NEAR(nearest->squared_distance, (points[nearest->index] - query).squaredNorm(), 1e-12);
      close += std::sqrt(nearest->squared_distance) < 1.5 * spacing ? 1 : 0;
    }
    EXPECT_GT(found, asked * 9 / 10) << "all but those at the rim of the picture";
    EXPECT_GT(close, found * 3 / 4) << "where the surface is not oblique";
  }
}

TEST(PixelIndex, FindsNothingOutOfSight) {
  const RangeScan scan = test::scan_from_sides(test::balls_field(), 0).scans[0];
  const auto& points = scan.cloud.positions;
  const double spacing = ingest::point_spacing(scan);
  EXPECT_FALSE(PixelIndex(scan.view, points, spacing).nearest(Eigen::Vector3d(1e4, 1e4, 1e4)));
  EXPECT_FALSE(PixelIndex({}, points, spacing).nearest(points[0])) << "the view is unknown";
  EXPECT_FALSE(PixelIndex(scan.view, {}, spacing).nearest(points[0])) << "there are no points";
}

}  // namespace
}  // namespace drape::registration
