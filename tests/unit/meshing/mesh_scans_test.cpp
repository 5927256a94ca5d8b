#include "drape/meshing/mesh_scans.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>

#include "drape/base/parallel.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "drape/meshing/mesh_quality.hpp"
#include "shapes.hpp"
#include "spot_mending.hpp"
#include "support.hpp"

namespace drape::meshing {
namespace {

using std::numbers::pi;

MeshOptions with_method(Method method) {
  MeshOptions options;
  options.method = method;
  options.merge_voxel_spacings = 0;
  return options;
}

MeshResult mesh_cloud(const PointCloud& cloud, double spacing, const MeshOptions& options) {
  return mesh_scans({{}, {}, cloud, spacing}, options);
}

// What every result promises.
void expect_sound(const TriangleMesh& mesh) {
  EXPECT_EQ(problem_of(mesh), "");
  const MeshQuality quality = mesh_quality(mesh);
  EXPECT_TRUE(quality.manifold()) << quality.non_manifold_edges << " edges, " << quality.non_manifold_vertices
                                  << " vertices, " << quality.inconsistent_edges << " inconsistent";
  EXPECT_EQ(mesh.normals.size(), mesh.vertices.size());
}

class MergedCloudMethods : public testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(, MergedCloudMethods, testing::Values(Method::poisson, Method::advancing_front),
                         [](const auto& method) {
                           return method.param == Method::poisson ? "poisson" : "advancing_front";
                         });

TEST_P(MergedCloudMethods, SphereIsClosedOutwardAndInPlace) {
  const Eigen::Vector3d center(100, -50, 7);
  const TriangleMesh mesh =
      mesh_cloud(test::sampled_sphere(10, 0.5, 0, center), 0.5, with_method(GetParam())).mesh;
  expect_sound(mesh);
  const MeshQuality quality = mesh_quality(mesh);
  EXPECT_EQ(quality.boundary_edges, 0U);
  EXPECT_EQ(quality.genus, 0);
  // A facet of circumradius rho = 2 spacings lies rho^2 / 2r = 0.05 below the sphere, the middle of its
  // circle is up to 0.125 off the implicit surface, and that is linear between places 0.5 apart.
  EXPECT_LT(test::worst_distance(mesh, [&](const Eigen::Vector3d& p) { return (p - center).norm() - 10; }),
            0.25);
  ASSERT_TRUE(quality.volume.has_value());
  EXPECT_NEAR(*quality.volume, 4.0 / 3 * pi * 1000, 40);
}

TEST_P(MergedCloudMethods, NoiseStaysNoise) {
  const double noise = 0.05;
  const TriangleMesh mesh =
      mesh_cloud(test::sampled_sphere(10, 0.5, noise), 0.5, with_method(GetParam())).mesh;
  expect_sound(mesh);
  EXPECT_LT(test::worst_distance(mesh, [&](const Eigen::Vector3d& p) { return p.norm() - 10; }),
            0.1 + 5 * noise);
}

TEST_P(MergedCloudMethods, TorusHasGenusOne) {
  const TriangleMesh mesh = mesh_cloud(test::sampled_torus(10, 4, 0.6), 0.6, with_method(GetParam())).mesh;
  expect_sound(mesh);
  EXPECT_EQ(mesh_quality(mesh).genus, 1);
  EXPECT_EQ(mesh_quality(mesh).boundary_loops, 0U);
  EXPECT_NEAR(signed_volume(mesh), 2 * pi * pi * 10 * 16, 60);
}

TEST_P(MergedCloudMethods, BoxKeepsItsVolume) {
  const TriangleMesh mesh = mesh_cloud(test::sampled_box({5, 4, 3}, 0.5), 0.5, with_method(GetParam())).mesh;
  expect_sound(mesh);
  EXPECT_EQ(mesh_quality(mesh).boundary_loops, 0U);
  // Rounded to radius r, its 96 of edge lose (1 - pi / 4) * 96 r^2: 30 for about two spacings.
  EXPECT_NEAR(signed_volume(mesh), 480, 30);
}

TEST_P(MergedCloudMethods, HalfASphereStaysOpen) {
  PointCloud cloud;
  const PointCloud whole = test::sampled_sphere(10, 0.5);
  for (std::size_t i = 0; i < whole.size(); ++i)
    if (whole.positions[i].z() > 0) {
      cloud.positions.push_back(whole.positions[i]);
      cloud.normals.push_back(whole.normals[i]);
    }
  const MeshResult result = mesh_cloud(cloud, 0.5, with_method(GetParam()));
  expect_sound(result.mesh);
  EXPECT_EQ(mesh_quality(result.mesh).boundary_loops, 1U);
  double lowest = 0;
  for (const Eigen::Vector3d& p : result.mesh.vertices) lowest = std::min(lowest, p.z());
  EXPECT_GT(lowest, -0.5 * MeshOptions{}.trim_spacings - 1e-9);
  for (std::size_t i = 0; i < result.mesh.faces.size(); ++i)
    EXPECT_GT(scaled_face_normal(result.mesh, i).dot(result.mesh.vertices[result.mesh.faces[i][0]]), 0);
}

TEST_P(MergedCloudMethods, SeparatePiecesAreAllFound) {
  PointCloud cloud = test::sampled_sphere(10, 0.5);
  for (const double x : {30.0, -40.0}) {
    const PointCloud other = test::sampled_sphere(3, 0.5, 0, {x, 25, 5});
    cloud.positions.insert(cloud.positions.end(), other.positions.begin(), other.positions.end());
    cloud.normals.insert(cloud.normals.end(), other.normals.begin(), other.normals.end());
  }
  MeshOptions options = with_method(GetParam());
  EXPECT_EQ(mesh_quality(mesh_cloud(cloud, 0.5, options).mesh).components, 3U);
  options.min_component_percent = 15;
  const MeshResult largest = mesh_cloud(cloud, 0.5, options);
  EXPECT_EQ(mesh_quality(largest.mesh).components, 1U);
  EXPECT_EQ(largest.components_removed, 2U);
}

TEST_P(MergedCloudMethods, AttributesComeFromTheSamplesNearBy) {
  PointCloud cloud = test::sampled_sphere(10, 0.5);
  for (const Eigen::Vector3d& p : cloud.positions) {
    cloud.colors.push_back(p.z() > 0 ? Eigen::Vector3f(1, 0, 0) : Eigen::Vector3f(0, 0, 1));
    cloud.intensities.push_back(static_cast<float>((p.x() + 10) / 20));
    cloud.confidences.push_back(0.5F);
  }
  const TriangleMesh mesh = mesh_cloud(cloud, 0.5, with_method(GetParam())).mesh;
  ASSERT_EQ(mesh.colors.size(), mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Eigen::Vector3d& p = mesh.vertices[v];
    if (std::abs(p.z()) > 1) {
      EXPECT_EQ(mesh.colors[v], p.z() > 0 ? Eigen::Vector3f(1, 0, 0) : Eigen::Vector3f(0, 0, 1));
    }
    EXPECT_NEAR(mesh.intensities[v], (p.x() + 10) / 20, 0.05);
    EXPECT_EQ(mesh.confidences[v], 0.5F);
  }
}

TEST_P(MergedCloudMethods, UnitAndThreadsDoNotMatter) {
  const PointCloud cloud = test::sampled_sphere(10, 0.8, 0.03);
  PointCloud scaled = cloud;
  for (Eigen::Vector3d& p : scaled.positions) p *= 1024;
  const TriangleMesh mesh = mesh_cloud(cloud, 0.8, with_method(GetParam())).mesh;
  set_thread_count(1);
  const TriangleMesh other_unit = mesh_cloud(scaled, 0.8 * 1024, with_method(GetParam())).mesh;
  set_thread_count(0);
  ASSERT_EQ(mesh.faces, other_unit.faces);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    EXPECT_EQ(Eigen::Vector3d(1024 * mesh.vertices[v]), other_unit.vertices[v]);
}

TEST(Poisson, EndsWhereItsSurfaceOfFlatSamplesDoesNot) {
  // CGAL's mesher followed this one without end.
  PointCloud disc;
  constexpr double radius = 16;
  for (double x = -radius; x <= radius; ++x)
    for (double y = -radius; y <= radius; ++y)
      if (x * x + y * y <= radius * radius) disc.positions.emplace_back(x, y, 0);
  disc.normals.assign(disc.size(), Eigen::Vector3f(0, 0, 1));
  const std::string message =
      test::error_message(ErrorCode::input, [&] { (void)mesh_cloud(disc, 1, with_method(Method::poisson)); });
  EXPECT_NE(message.find("no closed surface round the 797 samples"), std::string::npos) << message;
}

TEST_P(MergedCloudMethods, RefusesWhatIsNoSurface) {
  const auto message = [](const PointCloud& cloud) {
    return test::error_message(ErrorCode::input,
                               [&] { (void)mesh_cloud(cloud, 1, with_method(GetParam())); });
  };
  const auto cloud = [](std::vector<Eigen::Vector3d> positions) {
    PointCloud c;
    c.normals.assign(positions.size(), Eigen::Vector3f(0, 0, 1));
    c.positions = std::move(positions);
    return c;
  };
  EXPECT_NE(message({}).find("merged scans have 0"), std::string::npos);
  EXPECT_NE(message(cloud({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})).find("merged scans have 3"), std::string::npos);
  EXPECT_NE(message(cloud(std::vector<Eigen::Vector3d>(100, {1, 2, 3}))).find("merged scans have 1"),
            std::string::npos);
  std::vector<Eigen::Vector3d> line;
  for (int i = 0; i < 100; ++i) line.emplace_back(i, 2 * i, 3 * i);
  EXPECT_NE(message(cloud(line)).find("on one line"), std::string::npos);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(message(cloud(std::vector<Eigen::Vector3d>(100, {nan, 0, 0}))).find("merged scans have 0"),
            std::string::npos);
}

TEST_P(MergedCloudMethods, LeavesOutSamplesThatAreNotFinite) {
  PointCloud cloud = test::sampled_sphere(10, 0.5);
  const TriangleMesh clean = mesh_cloud(cloud, 0.5, with_method(GetParam())).mesh;
  cloud.positions.emplace_back(std::numeric_limits<double>::quiet_NaN(), 0, 0);
  cloud.normals.emplace_back(0, 0, 1);
  cloud.positions.emplace_back(0, std::numeric_limits<double>::infinity(), 0);
  cloud.normals.emplace_back(0, 0, 1);
  EXPECT_EQ(mesh_cloud(cloud, 0.5, with_method(GetParam())).mesh.faces, clean.faces);
}

TEST_P(MergedCloudMethods, CoplanarSamplesMakeASheet) {
  PointCloud cloud;
  for (int x = 0; x < 30; ++x)
    for (int y = 0; y < 30; ++y) {
      cloud.positions.emplace_back(x, y, 5);
      cloud.normals.emplace_back(0, 0, -1);
    }
  const TriangleMesh mesh = mesh_cloud(cloud, 1, with_method(GetParam())).mesh;
  expect_sound(mesh);
  EXPECT_GT(surface_area(mesh), 29 * 29 * 0.97);
  EXPECT_LT(test::worst_distance(mesh, [](const Eigen::Vector3d& p) { return p.z() - 5; }),
            1);  // poisson bends beyond the rim
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) EXPECT_LT(scaled_face_normal(mesh, i).z(), 1e-9);
}

TEST_P(MergedCloudMethods, NormalsAgainstTheScannersAreTurned) {
  PointCloud cloud = test::sampled_sphere(10, 0.5);
  std::vector<RangeScan> scans;
  for (const double side : {-1.0, 1.0}) {
    RangeScan scan;
    scan.view.kind = ScanView::Kind::origin;
    scan.view.vector = {0, 0, 100 * side};
    for (const Eigen::Vector3d& p : cloud.positions)
      if (p.z() * side > 1) scan.cloud.positions.push_back(p);
    scans.push_back(scan);
  }
  for (Eigen::Vector3f& n : cloud.normals) n = -n;
  const std::vector<Rigid3> poses(2, Rigid3::Identity());
  const MeshResult result = mesh_scans({scans, poses, cloud, 0.5}, with_method(GetParam()));
  EXPECT_TRUE(result.normals_reversed);
  EXPECT_GT(signed_volume(result.mesh), 4000);
}

TEST_P(MergedCloudMethods, StopsWhenAsked) {
  const std::atomic<bool> stop{true};
  const PointCloud cloud = test::sampled_sphere(10, 0.5);
  EXPECT_THROW((void)mesh_scans({{}, {}, cloud, 0.5}, with_method(GetParam()), Progress({}, &stop)),
               Interrupted);
}

TEST(Poisson, NeedsNormals) {
  PointCloud cloud = test::sampled_sphere(10, 1);
  cloud.normals.clear();
  const std::string message = test::error_message(
      ErrorCode::input, [&] { (void)mesh_cloud(cloud, 1, with_method(Method::poisson)); });
  EXPECT_NE(message.find("normals"), std::string::npos);
}

TEST(Poisson, OptionsSetTheSizeOfItsTriangles) {
  const PointCloud cloud = test::sampled_sphere(10, 1);
  const auto faces = [&](double radius, double distance) {
    MeshOptions options = with_method(Method::poisson);
    options.poisson_radius_spacings = radius;
    options.poisson_distance_spacings = distance;
    return mesh_cloud(cloud, 1, options).mesh.faces.size();
  };
  // A face of radius r is r^2 / 20 off the sphere.
  EXPECT_GT(faces(2, 1), 2 * faces(20, 1));
  EXPECT_GT(faces(20, 0.1), 2 * faces(20, 1));
}

TEST(Poisson, IsTrimmedWhereAsked) {
  PointCloud cloud;
  const PointCloud whole = test::sampled_sphere(10, 1);
  for (std::size_t i = 0; i < whole.size(); ++i)
    if (whole.positions[i].z() > 0) {
      cloud.positions.push_back(whole.positions[i]);
      cloud.normals.push_back(whole.normals[i]);
    }
  MeshOptions options = with_method(Method::poisson);
  const MeshResult by_default = mesh_cloud(cloud, 1, options);
  options.trim_spacings = 1.5;
  const MeshResult close = mesh_cloud(cloud, 1, options);
  EXPECT_GT(close.faces_trimmed, by_default.faces_trimmed);
  EXPECT_LT(surface_area(close.mesh), surface_area(by_default.mesh));
}

TEST(ScaleSpace, FollowsNoisySamplesRoundASphere) {
  PointCloud cloud = test::sampled_sphere(10, 0.5, 0.05);
  const MeshResult result = mesh_cloud(cloud, 0.5, with_method(Method::scale_space));
  expect_sound(result.mesh);
  EXPECT_GT(surface_area(result.mesh), 0.98 * 4 * pi * 100);
  EXPECT_LT(test::worst_distance(result.mesh, [](const Eigen::Vector3d& p) { return p.norm() - 10; }),
            0.1 + 5 * 0.05);
  for (std::size_t i = 0; i < result.mesh.faces.size(); ++i)
    EXPECT_GT(scaled_face_normal(result.mesh, i).dot(result.mesh.vertices[result.mesh.faces[i][0]]), 0);
}

TEST(Crossings, AreCutOutAndTheCutIsClosed) {
  TriangleMesh mesh = test::sphere(10, 32);
  const TriangleMesh sound = mesh;
  // One vertex pulled sideways over its neighbours, and one through the far side.
  mesh.vertices[200] += 2.5 * mesh.vertices[200].unitOrthogonal();
  mesh.vertices[900] *= -1.05;
  const std::size_t pairs = self_intersecting_pairs(mesh).size();
  ASSERT_GT(pairs, 5U);
  const Uncrossed mended = with_crossings_mended(mesh);
  EXPECT_EQ(mended.found, pairs);
  EXPECT_EQ(mended.left, 0U);
  EXPECT_EQ(self_intersecting_pairs(mended.mesh).size(), 0U);
  EXPECT_TRUE(mesh_quality(mended.mesh).closed());
  EXPECT_NEAR(signed_volume(mended.mesh), signed_volume(sound), 0.02 * signed_volume(sound));
  EXPECT_EQ(with_crossings_mended(sound).mesh.faces, sound.faces);
}

TEST(AdvancingFront, NeedsNoNormals) {
  PointCloud cloud = test::sampled_sphere(10, 0.5);
  cloud.normals.clear();
  const TriangleMesh mesh = mesh_cloud(cloud, 0.5, with_method(Method::advancing_front)).mesh;
  expect_sound(mesh);
  EXPECT_GT(signed_volume(mesh), 4000);
}

TEST(AdvancingFront, OverlappingScansAreMergedFirst) {
  PointCloud cloud = test::sampled_sphere(10, 0.5, 0.05);
  const PointCloud second = test::sampled_sphere(10, 0.47, 0.05);
  cloud.positions.insert(cloud.positions.end(), second.positions.begin(), second.positions.end());
  cloud.normals.insert(cloud.normals.end(), second.normals.begin(), second.normals.end());
  MeshOptions options;
  options.method = Method::advancing_front;
  const MeshResult result = mesh_cloud(cloud, 0.5, options);
  EXPECT_LT(result.samples_used, cloud.size() / 3);
  const MeshQuality quality = mesh_quality(result.mesh);
  EXPECT_TRUE(quality.closed());
  EXPECT_EQ(quality.genus, 0);
}

// A scanner that looks down at z = 0 with a block 20 high on it, and a gap in the lattice.
RangeScan block_on_a_table() {
  RangeScan scan;
  scan.file = "block.ply";
  scan.spacing = 1;
  scan.view.kind = ScanView::Kind::direction;
  scan.view.vector = {0, 0, -1};
  RangeGrid grid;
  grid.rows = 40;
  grid.columns = 50;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const bool gap = row == 35 && column > 5 && column < 9;
      const bool block = row >= 10 && row < 20 && column >= 10 && column < 20;
      grid.cells.push_back(gap ? RangeGrid::missing : static_cast<std::int32_t>(scan.cloud.size()));
      if (!gap) scan.cloud.positions.emplace_back(column, row, block ? 20.0 : 0.0);
    }
  scan.grid = grid;
  return scan;
}

MeshResult mesh_grid(const std::vector<RangeScan>& scans, const std::vector<Rigid3>& poses,
                     const MeshOptions& options) {
  const PointCloud none;
  return mesh_scans({scans, poses, none, 1}, options);
}

TEST(Grid, IsExactToItsSamplesAndCutsDepthSteps) {
  const RangeScan scan = block_on_a_table();
  const MeshResult result = mesh_grid({scan}, {Rigid3::Identity()}, with_method(Method::grid));
  expect_sound(result.mesh);
  EXPECT_EQ(mesh_quality(result.mesh).components, 2U);
  EXPECT_EQ(result.mesh.vertices.size(), scan.cloud.size());
  const auto less = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::array{a.x(), a.y(), a.z()} < std::array{b.x(), b.y(), b.z()};
  };
  const std::set<Eigen::Vector3d, decltype(less)> samples(scan.cloud.positions.begin(),
                                                          scan.cloud.positions.end(), less);
  for (const Eigen::Vector3d& v : result.mesh.vertices) EXPECT_EQ(samples.count(v), 1U);
  // All but the ring of lattice cells round the block, of whose corners half a cell may stay.
  EXPECT_NEAR(surface_area(result.mesh), 39 * 49 - (11 * 11 - 9 * 9) + 1, 1);
  for (std::size_t i = 0; i < result.mesh.faces.size(); ++i) {
    EXPECT_GT(scaled_face_normal(result.mesh, i).z(), 0);
    const Face& f = result.mesh.faces[i];
    EXPECT_EQ(result.mesh.vertices[f[0]].z(), result.mesh.vertices[f[1]].z());
  }
}

TEST(Grid, IncidenceLimitCutsSlopes) {
  RangeScan scan = block_on_a_table();
  for (Eigen::Vector3d& p : scan.cloud.positions) p.z() = p.x() < 25 ? 0 : 3 * (p.x() - 25);  // 71.6 degrees
  MeshOptions options = with_method(Method::grid);
  options.min_component_percent = 0;
  EXPECT_NEAR(surface_area(mesh_grid({scan}, {Rigid3::Identity()}, options).mesh),
              39 * (25 + 24 * std::sqrt(10.0)), 1e-6);
  options.grid_max_incidence_deg = 70;
  EXPECT_NEAR(surface_area(mesh_grid({scan}, {Rigid3::Identity()}, options).mesh), 39 * 25, 1e-6);
  options.grid_max_incidence_deg = 85;
  options.grid_max_edge_spacings = 3;
  EXPECT_NEAR(surface_area(mesh_grid({scan}, {Rigid3::Identity()}, options).mesh), 39 * 25, 1e-6);
}

TEST(Grid, SheetsOfSeveralScansArePlacedWithTheirAttributes) {
  RangeScan scan = block_on_a_table();
  scan.cloud.colors.assign(scan.cloud.size(), Eigen::Vector3f(0.25F, 0.5F, 1));
  scan.cloud.intensities.assign(scan.cloud.size(), 0.5F);
  RangeScan plain = scan;
  plain.cloud.intensities.clear();
  Rigid3 turned = Rigid3::Identity();
  turned.linear() = Eigen::AngleAxisd(pi, Eigen::Vector3d::UnitX()).toRotationMatrix();
  turned.translation() = Eigen::Vector3d(0, 0, -10);
  const MeshResult result = mesh_grid({scan, plain}, {Rigid3::Identity(), turned}, with_method(Method::grid));
  expect_sound(result.mesh);
  EXPECT_EQ(result.mesh.vertices.size(), 2 * scan.cloud.size());
  EXPECT_EQ(result.mesh.colors, std::vector<Eigen::Vector3f>(2 * scan.cloud.size(), {0.25F, 0.5F, 1}));
  EXPECT_TRUE(result.mesh.intensities.empty());
  for (std::size_t i = 0; i < result.mesh.faces.size(); ++i) {
    const double z = result.mesh.vertices[result.mesh.faces[i][0]].z();
    EXPECT_GT(scaled_face_normal(result.mesh, i).z() * (z < -5 ? -1 : 1), 0);
  }
}

TEST(Grid, NormalsOrientItWithoutAView) {
  RangeScan scan = block_on_a_table();
  scan.view.kind = ScanView::Kind::unknown;
  scan.cloud.normals.assign(scan.cloud.size(), Eigen::Vector3f(0, 0, -1));
  const TriangleMesh mesh = mesh_grid({scan}, {Rigid3::Identity()}, with_method(Method::grid)).mesh;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) EXPECT_LT(scaled_face_normal(mesh, i).z(), 0);
}

TEST(Grid, NeedsAGrid) {
  RangeScan scan = block_on_a_table();
  scan.grid.reset();
  const std::string message = test::error_message(
      ErrorCode::input, [&] { (void)mesh_grid({scan}, {Rigid3::Identity()}, with_method(Method::grid)); });
  EXPECT_NE(message.find("range grid"), std::string::npos);
}

}  // namespace
}  // namespace drape::meshing
