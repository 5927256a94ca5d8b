// Meshes and scans that were not made for a test.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "drape/geometry/mesh_topology.hpp"
#include "drape/ingest/clean_scan.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/scan_files.hpp"
#include "drape/meshing/hole_filling.hpp"
#include "drape/meshing/mesh_quality.hpp"
#include "drape/meshing/mesh_scans.hpp"
#include "drape/metrics/surface_distance.hpp"
#include "support.hpp"

namespace drape::meshing {
namespace {

struct Expected {
  std::string file;
  std::size_t loops;          // simple ones
  std::size_t outer_borders;  // of them
};

class RealMeshes : public testing::TestWithParam<Expected> {};
INSTANTIATE_TEST_SUITE_P(, RealMeshes,
                         testing::Values(Expected{"bun_zipper.ply", 5, 0},
                                         // 32 holes, of which six touch others, and the rim
                                         Expected{"many_small_holes.ply", 38, 1},
                                         Expected{"Laurana50k.ply", 4, 0}),
                         [](const auto& mesh) {
                           return std::filesystem::path(mesh.param.file).stem().string();
                         });

TEST_P(RealMeshes, EveryHoleIsFilledAndNothingElseMoves) {
  const std::string name = "meshes/" + GetParam().file;
  if (!test::have_data(name)) GTEST_SKIP() << "needs " << name << " of DRAPE_TEST_DATA";
  const TriangleMesh mesh = io::read_mesh(test::data(name));
  const FillResult result = fill_holes(mesh, median_edge_length(mesh), {});
  ASSERT_EQ(result.holes.size(), GetParam().loops);
  std::size_t open = 0;
  for (const Hole& hole : result.holes)
    if (!hole.filled()) {
      ++open;
      EXPECT_EQ(hole.why, "outer border of an open sheet");
    } else {
      EXPECT_GT(hole.faces_added, 0U);
    }
  EXPECT_EQ(open, GetParam().outer_borders);
  EXPECT_EQ(result.self_intersections, 0U);
  for (const TriangleMesh* made : {&result.mesh, &result.simplified}) {
    EXPECT_EQ(problem_of(*made), "");
    const MeshQuality quality = mesh_quality(*made);
    EXPECT_TRUE(quality.manifold());
    EXPECT_EQ(quality.boundary_loops, open);
    EXPECT_EQ(quality.genus, 0);
  }
  EXPECT_LE(result.simplified.faces.size(), 60000U);
  ASSERT_GE(result.mesh.vertices.size(), mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) ASSERT_EQ(mesh.vertices[v], result.mesh.vertices[v]);
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) ASSERT_EQ(mesh.faces[i], result.mesh.faces[i]);
}

TEST(RealTeapot, LoopsAreJoinedOrFilled) {
  if (!test::have_data("meshes/teapot.obj")) GTEST_SKIP() << "needs meshes/teapot.obj of DRAPE_TEST_DATA";
  const TriangleMesh mesh = io::read_mesh(test::data("meshes/teapot.obj"));
  FillOptions options;
  for (const Hole& hole : fill_holes(mesh, median_edge_length(mesh), options).holes)
    EXPECT_TRUE(hole.filled() || hole.why == "outer border of an open sheet") << hole.why;
  options.keep_outer_border = false;
  const FillResult result = fill_holes(mesh, median_edge_length(mesh), options);
  // Borders with the same coordinates are joined first: those loops are gone before there is a hole to fill.
  EXPECT_GT(boundary_loops(mesh).size(), result.holes.size());
  EXPECT_GT(result.vertices_joined, 0U);
  EXPECT_TRUE(mesh_quality(result.mesh).closed());
}

struct Bunny {
  std::vector<RangeScan> scans;
  std::vector<Rigid3> poses;
  PointCloud cloud;
};

Bunny raw_bunny() {
  Bunny bunny;
  for (const auto& [file, pose] : io::read_scan_poses(test::data("scans/bunny/bun.conf"))) {
    for (const RangeScan& scan : io::read_scans(test::data("scans/bunny/" + file))) {
      const RangeScan clean = ingest::clean_scan(scan, {}, {}).scan;
      for (std::size_t i = 0; i < clean.cloud.size(); ++i) {
        bunny.cloud.positions.push_back(pose * clean.cloud.positions[i]);
        bunny.cloud.normals.push_back(pose.linear().cast<float>() * clean.cloud.normals[i]);
      }
      bunny.scans.push_back(clean);
      bunny.poses.push_back(pose);
    }
  }
  return bunny;
}

TEST(RealScans, TheBunnyMatchesStanfordsOwnMesh) {
  if (!test::have_data("scans/bunny") || !test::have_data("meshes/bun_zipper.ply"))
    GTEST_SKIP() << "needs scans/bunny and meshes/bun_zipper.ply of DRAPE_TEST_DATA";
  const Bunny bunny = raw_bunny();
  const TriangleMesh reference = io::read_mesh(test::data("meshes/bun_zipper.ply"));
  MeshOptions options;
  for (const Method method : {Method::poisson, Method::advancing_front}) {
    options.method = method;
    options.merge_voxel_spacings = 4;  // coarse enough for a unit test
    options.poisson_radius_spacings = 6;
    const TriangleMesh mesh = mesh_scans({bunny.scans, bunny.poses, bunny.cloud, 0.0005}, options).mesh;
    const MeshQuality quality = mesh_quality(mesh);
    EXPECT_TRUE(quality.manifold());
    EXPECT_EQ(quality.components, 1U);
    const metrics::TwoWayDistance distance = metrics::two_way_distance(mesh, reference, {20000, 1});
    EXPECT_LT(distance.extra.mean, 0.0005);
    EXPECT_LT(distance.missing.mean, 0.0005);
    RecordProperty("extra_mean_um", static_cast<int>(1e6 * distance.extra.mean));
    RecordProperty("missing_mean_um", static_cast<int>(1e6 * distance.missing.mean));
  }
}

}  // namespace
}  // namespace drape::meshing
