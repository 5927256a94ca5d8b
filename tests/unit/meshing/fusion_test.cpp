// Range fusion against shapes that are known in closed form.
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "analytic_scans.hpp"
#include "drape/base/parallel.hpp"
#include "drape/geometry/kd_tree.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "drape/meshing/mesh_quality.hpp"
#include "drape/meshing/mesh_scans.hpp"
#include "shapes.hpp"
#include "support.hpp"

namespace drape::meshing {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;
using test::DistanceField;
using test::LatticeSetup;

struct Scans {
  std::vector<RangeScan> scans;
  std::vector<Rigid3> world_from_scan;
};

// The scanner of LatticeSetup, turned so that it looks from `from` (a direction) at the origin.
Rigid3 looking_from(const Vector3d& from) {
  return Rigid3(Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), from));
}

Scans scans_of(const DistanceField& field, const std::vector<Vector3d>& from, LatticeSetup setup = {}) {
  Scans all;
  for (const Vector3d& direction : from) {
    ++setup.seed;
    all.world_from_scan.push_back(looking_from(direction));
    all.scans.push_back(test::scan_field(field, all.world_from_scan.back(), setup));
    all.scans.back().spacing = setup.pitch;
  }
  return all;
}

std::vector<Vector3d> six_sides() {
  return {{1, 0.1, 0.2}, {-1, 0.1, 0.2}, {0.2, 1, 0.1}, {0.2, -1, 0.1}, {0.1, 0.2, 1}, {0.1, 0.2, -1}};
}

MeshResult fuse(const Scans& all, MeshOptions options = {}) {
  options.method = Method::fusion;
  const PointCloud none;
  return mesh_scans({all.scans, all.world_from_scan, none, 1}, options);
}

void expect_sound(const TriangleMesh& mesh) {
  EXPECT_EQ(problem_of(mesh), "");
  const MeshQuality quality = mesh_quality(mesh);
  EXPECT_TRUE(quality.manifold()) << quality.non_manifold_edges << " edges, " << quality.non_manifold_vertices
                                  << " vertices, " << quality.inconsistent_edges << " inconsistent";
  EXPECT_EQ(quality.self_intersections, 0U);
  EXPECT_EQ(mesh.normals.size(), mesh.vertices.size());
}

class SphereFromSixSides : public testing::TestWithParam<std::pair<bool, bool>> {};
INSTANTIATE_TEST_SUITE_P(, SphereFromSixSides,
                         testing::Values(std::pair(false, true), std::pair(true, true),
                                         std::pair(false, false), std::pair(true, false)),
                         [](const auto& kind) {
                           return std::string(kind.param.first ? "Diverging" : "Parallel") +
                                  (kind.param.second ? "WithGrid" : "WithoutGrid");
                         });

TEST_P(SphereFromSixSides, IsClosedOutwardAndInPlace) {
  const Vector3d center(3, -2, 1);
  LatticeSetup setup;
  setup.diverging = GetParam().first;
  Scans all = scans_of(test::sphere_field(20, center), six_sides(), setup);
  if (!GetParam().second)
    for (RangeScan& scan : all.scans) scan = test::without_grid(scan);
  const MeshResult result = fuse(all);
  expect_sound(result.mesh);
  const MeshQuality quality = mesh_quality(result.mesh);
  EXPECT_EQ(quality.boundary_edges, 0U);
  EXPECT_EQ(quality.genus, 0);
  // A plane through 3 x 3 samples at slope s lies about (1 + s^2) h^2 2/3 / r off: 0.13 at 60 degrees.
  EXPECT_LT(test::worst_distance(result.mesh, [&](const Vector3d& p) { return (p - center).norm() - 20; }),
            0.2);
  ASSERT_TRUE(quality.volume.has_value());
  EXPECT_NEAR(*quality.volume, 4.0 / 3 * pi * 8000, 0.07 * 4 * pi * 400);
}

TEST(Fusion, NoiseIsAveragedAcrossScansAndNeighbours) {
  LatticeSetup setup;
  setup.noise = 0.3;
  const TriangleMesh mesh = fuse(scans_of(test::sphere_field(20), six_sides(), setup)).mesh;
  expect_sound(mesh);
  double squares = 0;
  for (const Vector3d& p : mesh.vertices) squares += std::pow(p.norm() - 20, 2);
  // 3 x 3 planes leave a third of it, the mean of two or three scans some 60 % of that.
  EXPECT_LT(std::sqrt(squares / static_cast<double>(mesh.vertices.size())), 0.4 * setup.noise);
}

TEST(Fusion, HeavyNoiseIsAveragedOverMoreOfTheSurface) {
  LatticeSetup setup;
  setup.noise = 0.7;
  const TriangleMesh mesh = fuse(scans_of(test::sphere_field(20), six_sides(), setup)).mesh;
  double squares = 0;
  for (const Vector3d& p : mesh.vertices) squares += std::pow(p.norm() - 20, 2);
  // The mean of a few 3 x 3 planes would leave a third of it.
  EXPECT_LT(std::sqrt(squares / static_cast<double>(mesh.vertices.size())), 0.28 * setup.noise);
}

TEST(Fusion, HeavyNoiseDoesNotShrinkWhatIsRound) {
  LatticeSetup setup;
  setup.noise = 1;
  const TriangleMesh mesh = fuse(scans_of(test::sphere_field(20), six_sides(), setup)).mesh;
  double sum = 0;
  for (const Vector3d& p : mesh.vertices) sum += p.norm() - 20;
  EXPECT_NEAR(sum / static_cast<double>(mesh.vertices.size()), 0, 0.05 * setup.noise);
}

TEST(Fusion, HeavyNoiseLeavesCreasesSharp) {
  // A roof of 100 degrees.
  const DistanceField roof = [](const Vector3d& p) {
    return std::cos(50 * pi / 180) * std::abs(p.x()) + std::sin(50 * pi / 180) * p.z();
  };
  LatticeSetup setup;
  setup.noise = 0.8;
  const TriangleMesh mesh = fuse(scans_of(roof, {{0, 0, 1}, {0.1, 0.3, 1}, {-0.2, -0.1, 1}}, setup)).mesh;
  double squares = 0;
  double count = 0;
  for (const Vector3d& p : mesh.vertices) {
    if (std::abs(p.x()) > 2 || std::abs(p.y()) > 12) continue;
    squares += std::pow(roof(p), 2);
    count += 1;
  }
  EXPECT_LT(std::sqrt(squares / count), 0.3 * setup.noise);
}

TEST(Fusion, SharpEdgesOfABoxStayClosed) {
  const TriangleMesh mesh = fuse(scans_of(test::box_field({15, 12, 10}), six_sides())).mesh;
  expect_sound(mesh);
  const MeshQuality quality = mesh_quality(mesh);
  EXPECT_EQ(quality.components, 1U);
  EXPECT_NEAR(surface_area(mesh), 8 * (15 * 12 + 12 * 10 + 10 * 15), 250);
  // Half of its sides are seen at more than 78 degrees: there, beside edges, samples are five spacings apart.
  std::size_t far = 0;
  for (const Vector3d& p : mesh.vertices) far += std::abs(test::box_field({15, 12, 10})(p)) > 0.75 ? 1 : 0;
  EXPECT_LT(static_cast<double>(far), 0.01 * static_cast<double>(mesh.vertices.size()));
}

// A plate thinner than the truncation distance, seen from both sides: neither may wear the other away.
TEST(Fusion, ThinSheetSeenFromBothSidesSurvives) {
  for (const double thickness : {0.9, 1.3, 2.6}) {
    const Vector3d half(20, 20, thickness / 2);
    const TriangleMesh mesh = fuse(scans_of(test::box_field(half), {{0.1, 0.2, 1}, {0.2, -0.1, -1}})).mesh;
    expect_sound(mesh);
    double upper = 0;
    double lower = 0;
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
      const Vector3d normal = scaled_face_normal(mesh, i);
      const double z = mesh.vertices[mesh.faces[i][0]].z();
      if (mesh.vertices[mesh.faces[i][0]].head<2>().cwiseAbs().maxCoeff() > 17) continue;
      EXPECT_GT(normal.z() * z, 0);
      EXPECT_NEAR(std::abs(z), thickness / 2, 0.05);
      (z > 0 ? upper : lower) += normal.norm() / 2;
    }
    EXPECT_GT(upper, 34 * 34 * 0.97) << thickness;
    EXPECT_GT(lower, 34 * 34 * 0.97) << thickness;
  }
}

TEST(Fusion, OneScanIsAnOpenSheetThatEndsWhereItsSamplesEnd) {
  const RangeScan scan = test::scan_field(test::sphere_field(20), Rigid3::Identity(), {});
  const TriangleMesh mesh = fuse({{scan}, {Rigid3::Identity()}}).mesh;
  expect_sound(mesh);
  EXPECT_EQ(mesh_quality(mesh).boundary_loops, 1U);
  const KdTree tree(scan.cloud.positions);
  for (const Vector3d& p : mesh.vertices) EXPECT_TRUE(tree.nearest_within(p, 3)) << p.transpose();
}

TEST(Fusion, DepthStepsAreNotBridged) {
  const DistanceField field = test::united(test::sphere_field(8, {0, 0, 40}), test::box_field({25, 25, 2}));
  const Scans all = scans_of(field, {Vector3d::UnitZ()});
  MeshOptions options;
  options.min_component_percent = 0.1;
  const TriangleMesh mesh = fuse(all, options).mesh;
  EXPECT_EQ(mesh_quality(mesh).components, 2U);
  for (const Vector3d& p : mesh.vertices) EXPECT_TRUE(p.z() > 35 || p.z() < 5);
}

// A scanner in the middle of a room looks all around it.
TEST(Fusion, RoomRoundTheScannerHasNoSeams) {
  const Vector3d half(10, 8, 5);
  const DistanceField walls = [&](const Vector3d& p) { return -test::box_field(half)(p); };
  RangeScan scan;
  scan.view = {ScanView::Kind::origin, Vector3d::Zero()};
  scan.grid = RangeGrid{120, 240, {}};
  for (int row = 0; row < scan.grid->rows; ++row)
    for (int column = 0; column < scan.grid->columns; ++column) {
      const double elevation = pi * ((row + 0.5) / scan.grid->rows - 0.5);
      const double azimuth = 2 * pi * column / scan.grid->columns;
      const Vector3d direction(std::cos(elevation) * std::cos(azimuth),
                               std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      scan.grid->cells.push_back(static_cast<std::int32_t>(scan.cloud.size()));
      scan.cloud.positions.push_back(*test::hit(walls, Vector3d::Zero(), direction, 100) * direction);
    }
  scan.spacing = 0.2;
  const PointCloud none;
  const std::vector<Rigid3> poses{Rigid3::Identity()};
  const std::vector<RangeScan> scans{scan};
  const TriangleMesh mesh = mesh_scans({scans, poses, none, 0.2}, {}).mesh;
  expect_sound(mesh);
  EXPECT_EQ(mesh_quality(mesh).components, 1U);
  // Half a spacing of the farthest corners.
  EXPECT_LT(test::worst_distance(mesh, walls), 0.3);
  // All but the slit between the last and the first column and the caps at the poles; facing inward.
  EXPECT_GT(surface_area(mesh), 0.95 * 8 * (80 + 40 + 50));
  double inward = 0;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i)
    if (scaled_face_normal(mesh, i).dot(mesh.vertices[mesh.faces[i][0]]) < 0)
      inward += scaled_face_normal(mesh, i).norm() / 2;
  EXPECT_GT(inward, 0.999 * surface_area(mesh));
}

TEST(Fusion, GridAndNormalsDoWithoutAView) {
  Scans all = scans_of(test::sphere_field(20), six_sides());
  for (RangeScan& scan : all.scans) {
    for (const Vector3d& p : scan.cloud.positions) scan.cloud.normals.push_back(p.normalized().cast<float>());
    scan = test::without_view(scan);
  }
  const MeshResult result = fuse(all);
  EXPECT_TRUE(mesh_quality(result.mesh).closed());
  EXPECT_NEAR(signed_volume(result.mesh), 4.0 / 3 * pi * 8000, 0.07 * 4 * pi * 400);
}

TEST(Fusion, AttributesAreFusedWhereAllScansHaveThem) {
  Scans all = scans_of(test::sphere_field(20), six_sides());
  for (std::size_t s = 0; s < all.scans.size(); ++s)
    for (const Vector3d& p : all.scans[s].cloud.positions) {
      const bool up = (all.world_from_scan[s] * p).z() > 0;
      all.scans[s].cloud.colors.push_back(up ? Eigen::Vector3f(1, 0, 0) : Eigen::Vector3f(0, 0, 1));
      all.scans[s].cloud.confidences.push_back(up ? 0.75F : 0.25F);
      if (s > 0) all.scans[s].cloud.intensities.push_back(0.5F);
    }
  const TriangleMesh mesh = fuse(all).mesh;
  ASSERT_EQ(mesh.colors.size(), mesh.vertices.size());
  ASSERT_EQ(mesh.confidences.size(), mesh.vertices.size());
  EXPECT_TRUE(mesh.intensities.empty());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const double z = mesh.vertices[v].z();
    if (std::abs(z) < 10) continue;  // a sample of a scan from the side is up to six spacings long
    EXPECT_LT((mesh.colors[v] - (z > 0 ? Eigen::Vector3f(1, 0, 0) : Eigen::Vector3f(0, 0, 1))).norm(), 1e-4);
    EXPECT_NEAR(mesh.confidences[v], z > 0 ? 0.75 : 0.25, 1e-4);
  }
}

// From above and a little aside: the underside is unseen, the lattices reach past the shape on all sides.
TEST(Fusion, ClosedCarvesWhatNoScanSawThrough) {
  const std::vector<Vector3d> from{{0.5, 0, 1}, {-0.5, 0, 1}, {0, 0.5, 1}, {0, -0.5, 1}};
  LatticeSetup setup;
  setup.rows = setup.columns = 70;
  const Scans all = scans_of(test::sphere_field(20), from, setup);
  const TriangleMesh open = fuse(all).mesh;
  EXPECT_TRUE(open.filled.empty());
  EXPECT_GT(mesh_quality(open).boundary_loops, 0U);
  MeshOptions options;
  options.closed = true;
  const TriangleMesh mesh = fuse(all, options).mesh;
  EXPECT_TRUE(mesh_quality(mesh).closed());
  // What was seen stays as it is; unseen space counts as inside, as far as the box of what was seen.
  EXPECT_GT(signed_volume(mesh), 2.0 / 3 * pi * 8000);
  ASSERT_EQ(mesh.filled.size(), mesh.faces.size());
  double filled = 0;
  double scanned = 0;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const Vector3d& p = mesh.vertices[mesh.faces[i][0]];
    (mesh.filled[i] != 0 ? filled : scanned) += scaled_face_normal(mesh, i).norm() / 2;
    EXPECT_LT(p.cwiseAbs().maxCoeff(), 20 + 2 * 8 * 0.65);
    EXPECT_TRUE(mesh.filled[i] != 0 || std::abs(p.norm() - 20) < 2.5) << p.transpose();
    EXPECT_TRUE(p.z() < 5 || p.norm() > 19) << p.transpose();
  }
  EXPECT_GT(filled, 0);
  // A rim of two voxels round the border counts as scanned.
  EXPECT_NEAR(scanned, surface_area(open), 0.1 * scanned);
}

TEST(Fusion, VoxelSizeSetsTheTriangles) {
  const Scans all = scans_of(test::sphere_field(20), six_sides());
  MeshOptions coarse;
  coarse.fusion_voxel_spacings = 1.3;
  const double ratio = static_cast<double>(fuse(all).mesh.faces.size()) /
                       static_cast<double>(fuse(all, coarse).mesh.faces.size());
  EXPECT_NEAR(ratio, 4, 0.5);
}

TEST(Fusion, SameBytesForAnyNumberOfThreads) {
  LatticeSetup setup;
  setup.noise = 0.2;
  const Scans all = scans_of(test::sphere_field(20), six_sides(), setup);
  set_thread_count(1);
  const TriangleMesh one = fuse(all).mesh;
  set_thread_count(4);
  const TriangleMesh four = fuse(all).mesh;
  set_thread_count(0);
  EXPECT_EQ(one.vertices, four.vertices);
  EXPECT_EQ(one.faces, four.faces);
  EXPECT_EQ(one.normals, four.normals);
}

TEST(Fusion, FarFromTheOriginNothingChanges) {
  const Scans near = scans_of(test::sphere_field(20), six_sides());
  Scans far = near;
  const Vector3d shift(5e5, -4e6, 300);
  for (Rigid3& pose : far.world_from_scan) pose.pretranslate(shift);
  const TriangleMesh mesh = fuse(far).mesh;
  expect_sound(mesh);
  EXPECT_LT(test::worst_distance(mesh, [&](const Vector3d& p) { return (p - shift).norm() - 20; }), 0.2);
}

TEST(Fusion, OneScanTwiceIsTheScan) {
  const Scans once = scans_of(test::sphere_field(20), {Vector3d::UnitZ()});
  Scans twice = once;
  twice.scans.push_back(once.scans[0]);
  twice.world_from_scan.push_back(once.world_from_scan[0]);
  EXPECT_EQ(fuse(once).mesh.faces, fuse(twice).mesh.faces);
}

TEST(Fusion, SamplesThatAreNotFiniteAreLeftOut) {
  Scans all = scans_of(test::sphere_field(20), six_sides());
  const std::size_t vertices = fuse(all).mesh.vertices.size();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < all.scans[0].cloud.size(); i += 97)
    all.scans[0].cloud.positions[i] = {nan, 0, nan};
  const TriangleMesh mesh = fuse(all).mesh;
  expect_sound(mesh);
  EXPECT_NEAR(static_cast<double>(mesh.vertices.size()), static_cast<double>(vertices),
              0.02 * static_cast<double>(vertices));
}

TEST(Fusion, DisjointClustersAreAllFoundUnlessTooSmall) {
  const DistanceField field = test::united(test::sphere_field(15), test::sphere_field(4, {25, 0, 0}));
  LatticeSetup setup;
  setup.columns = 80;
  const Scans all = scans_of(field, six_sides(), setup);
  EXPECT_EQ(mesh_quality(fuse(all).mesh).components, 2U);
  MeshOptions options;
  options.min_component_percent = 20;
  const MeshResult largest = fuse(all, options);
  EXPECT_EQ(mesh_quality(largest.mesh).components, 1U);
  EXPECT_EQ(largest.components_removed, 1U);
}

TEST(Fusion, WithoutASurfaceItSaysSo) {
  const auto message = [](std::vector<Vector3d> points, bool view = true) {
    RangeScan scan;
    scan.cloud.positions = std::move(points);
    scan.spacing = 1;
    if (view) scan.view = {ScanView::Kind::direction, Vector3d::UnitZ()};
    return test::error_message(ErrorCode::input, [&] { (void)fuse({{scan}, {Rigid3::Identity()}}); });
  };
  std::vector<Vector3d> line;
  for (int i = 0; i < 50; ++i) line.emplace_back(i, 2 * i, 3);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& points :
       {std::vector<Vector3d>{}, line, std::vector<Vector3d>(20, {1, 2, 3}),
        std::vector<Vector3d>{{0, 0, 0}, {100, 0, 0}, {0, 100, 0}}, std::vector<Vector3d>(5, {nan, 0, 0})})
    EXPECT_NE(message(points).find("no surface"), std::string::npos) << message(points);
  EXPECT_NE(message(line, false).find("none of the 1"), std::string::npos);
  const PointCloud none;
  EXPECT_NE(test::error_message(ErrorCode::input, [&] { (void)mesh_scans({{}, {}, none, 1}, {}); }), "");
}

TEST(Fusion, ThreeSamplesAreATriangleOrAnError) {
  RangeScan scan;
  scan.cloud.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  scan.view = {ScanView::Kind::direction, -Vector3d::UnitZ()};
  scan.spacing = 1;
  try {
    const TriangleMesh mesh = fuse({{scan}, {Rigid3::Identity()}}).mesh;
    EXPECT_LT(surface_area(mesh), 10);
    for (std::size_t i = 0; i < mesh.faces.size(); ++i) EXPECT_GT(scaled_face_normal(mesh, i).z(), 0);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::input);
  }
}

TEST(Fusion, APointFarOffIsNoReasonToRunOutOfMemory) {
  Scans all = scans_of(test::sphere_field(20), {Vector3d::UnitZ()});
  all.scans[0].cloud.positions.emplace_back(1e12, 0, 0);  // not in the grid: in no face
  EXPECT_FALSE(fuse(all).mesh.empty());
  all.world_from_scan.push_back(looking_from(Vector3d::UnitZ()));
  all.world_from_scan[1].pretranslate(Vector3d(1e9, 0, 0));
  all.scans.push_back(all.scans[0]);
  EXPECT_NE(test::error_message(ErrorCode::input, [&] { (void)fuse(all); }).find("too far"),
            std::string::npos);
}

TEST(Fusion, StopsWhenAsked) {
  const std::atomic<bool> stop{true};
  const Scans all = scans_of(test::sphere_field(20), six_sides());
  const PointCloud none;
  EXPECT_THROW((void)mesh_scans({all.scans, all.world_from_scan, none, 1}, {}, Progress({}, &stop)),
               Interrupted);
}

TEST(AutomaticMethod, DependsOnWhatIsKnown) {
  Scans all = scans_of(test::sphere_field(20), six_sides());
  PointCloud cloud = test::sampled_sphere(20, 1);
  const auto method = [&] { return mesh_scans({all.scans, all.world_from_scan, cloud, 1}, {}).method; };
  EXPECT_EQ(method(), Method::fusion);
  EXPECT_FALSE(needs_cloud(all.scans, Method::automatic));
  EXPECT_TRUE(needs_cloud(all.scans, Method::poisson));
  all.scans[3] = test::without_view(all.scans[3]);
  EXPECT_EQ(method(), Method::poisson);
  EXPECT_TRUE(needs_cloud(all.scans, Method::automatic));
  cloud.normals.clear();
  EXPECT_EQ(method(), Method::advancing_front);
}

}  // namespace
}  // namespace drape::meshing
