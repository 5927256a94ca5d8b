#include <gtest/gtest.h>

#include "drape/io/mesh_files.hpp"
#include "drape/io/scan_files.hpp"
#include "drape/metrics/surface_distance.hpp"
#include "support.hpp"

namespace drape::metrics {
namespace {

// Stanford zippered the mesh from these scans: but for what was trimmed and averaged it is the scans' own
// surface. The scanner's resolution is half a millimetre.
TEST(RealBunny, ItsScansLieOnItsMesh) {
  for (const char* needed : {"scans/bunny", "meshes/bun_zipper.ply"})
    if (!test::have_data(needed)) GTEST_SKIP() << "needs " << needed << " of DRAPE_TEST_DATA";
  const TriangleMesh mesh = io::read_mesh(test::data("meshes/bun_zipper.ply"));
  const auto poses = io::read_scan_poses(test::data("scans/bunny/bun.conf"));
  for (const std::string name : {"bun000.ply", "bun090.ply", "bun270.ply"}) {
    const RangeScan scan = io::read_scans(test::data("scans/bunny/" + name)).front();
    std::vector<Eigen::Vector3d> points;
    for (std::size_t i = 0; i < scan.cloud.size(); i += 5)
      points.push_back(poses.at(name) * scan.cloud.positions[i]);
    const Distribution placed = surface_distance(points, mesh);
    EXPECT_LT(placed.median, 0.0005) << name;
    EXPECT_GT(placed.median, 0.00001) << name;  // the mesh is an average, not a copy
    // A millimetre beside its place, a scan is worse.
    for (Eigen::Vector3d& p : points) p += Eigen::Vector3d(0.001, 0.001, 0.001);
    EXPECT_GT(surface_distance(points, mesh).median, placed.median + 0.0003) << name;
  }
}

}  // namespace
}  // namespace drape::metrics
