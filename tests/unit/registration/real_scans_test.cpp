#include <gtest/gtest.h>

#include "drape/ingest/clean_scan.hpp"
#include "drape/io/scan_files.hpp"
#include "drape/registration/register_scans.hpp"
#include "shapes.hpp"
#include "support.hpp"

namespace drape::registration {
namespace {

TEST(RealScans, TheBunnysPosesAreRefinedAndFoundAgain) {
  if (!test::have_data("scans/bunny")) GTEST_SKIP() << "needs scans/bunny of DRAPE_TEST_DATA";
  test::ScannedShape bunny;
  for (const auto& [name, pose] : io::read_scan_poses(test::data("scans/bunny/bun.conf"))) {
    bunny.scans.push_back(
        ingest::clean_scan(io::read_scans(test::data("scans/bunny/" + name))[0], {}, {}).scan);
    bunny.world_from_scan.push_back(pose);
  }
  ASSERT_EQ(bunny.scans.size(), 10U);
  const Registration refined = register_scans(bunny.scans, bunny.given(), {}, {});
  EXPECT_TRUE(refined.converged);
  for (const PlacedScan& scan : refined.scans)
    EXPECT_LT(scan.moved_m, 0.3e-3) << "the published poses are good";
  double before = 0;
  double after = 0;
  for (const PairQuality& pair : refined.pairs) {
    if (pair.overlap < 0.1) continue;
    EXPECT_LT(pair.rms_m, 0.4e-3) << pair.first << " on " << pair.second;
    before += pair.rms_before_m;
    after += pair.rms_m;
  }
  EXPECT_LT(after, 0.96 * before);

  auto given = bunny.given();
  for (std::size_t i = 0; i < given.size(); ++i) {
    const Rigid3 about_the_middle(Eigen::Translation3d(0, 0.1, 0));
    given[i] = about_the_middle * test::perturbed(about_the_middle.inverse() * *given[i], 2, 2e-3, i);
  }
  const Registration found = register_scans(bunny.scans, given, {}, {});
  bunny.world_from_scan.clear();
  for (const PlacedScan& scan : refined.scans) bunny.world_from_scan.push_back(scan.world_from_scan);
  EXPECT_LT(test::relative_error(bunny, found), 0.02e-3) << "the same answer from 2 degrees and 2 mm away";
}

}  // namespace
}  // namespace drape::registration
