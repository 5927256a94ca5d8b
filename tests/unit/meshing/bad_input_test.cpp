// What is no proper input, through every method and through filling and simplifying: a right result or a
// clear error, one row per input.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <limits>
#include <numbers>
#include <string>

#include "analytic_scans.hpp"
#include "drape/base/error.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "drape/meshing/hole_filling.hpp"
#include "drape/meshing/mesh_quality.hpp"
#include "drape/meshing/mesh_scans.hpp"
#include "drape/meshing/simplify.hpp"
#include "support.hpp"

namespace drape::meshing {
namespace {

using Eigen::Vector3d;

constexpr double pitch = 2;
constexpr double radius = 12;
constexpr std::array methods{Method::fusion,      Method::poisson, Method::advancing_front,
                             Method::scale_space, Method::grid,    Method::automatic};

// Scans and what register makes of them: one cloud with normals towards the scanners.
struct Input {
  std::vector<RangeScan> scans;
  std::vector<Rigid3> poses;
  PointCloud cloud;

  void add(RangeScan scan, const Rigid3& pose) {
    scan.spacing = pitch;
    for (const Vector3d& p : scan.cloud.positions) {
      cloud.positions.push_back(pose * p);
      scan.cloud.normals.push_back(Eigen::Vector3f::UnitZ());
    }
    scans.push_back(std::move(scan));
    poses.push_back(pose);
  }
  void set_normals(const std::function<Vector3d(const Vector3d&)>& normal_at) {
    cloud.normals.clear();
    for (const Vector3d& p : cloud.positions) cloud.normals.push_back(normal_at(p).cast<float>());
  }
};

Input seen_sphere(double sign = 1) {
  Input input;
  test::LatticeSetup setup;
  setup.rows = setup.columns = 18;
  setup.pitch = pitch;
  for (const Vector3d& from : {Vector3d(1, .1, .2), Vector3d(-1, .1, .2), Vector3d(.2, 1, .1),
                               Vector3d(.2, -1, .1), Vector3d(.1, .2, 1), Vector3d(.1, .2, -1)}) {
    const Rigid3 pose(Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), from));
    input.add(test::scan_field(test::sphere_field(radius), pose, setup), pose);
  }
  input.set_normals([&](const Vector3d& p) { return Vector3d(sign * p.normalized()); });
  return input;
}

// One scan that looks down on these points, on a lattice of so many columns.
Input seen_from_above(const std::vector<Vector3d>& points, int columns) {
  RangeScan scan;
  scan.file = "bad.ply";
  scan.view = {ScanView::Kind::direction, -Vector3d::UnitZ()};
  scan.cloud.positions = points;
  scan.grid = RangeGrid{columns > 0 ? static_cast<int>(points.size()) / columns : 0, columns, {}};
  for (std::size_t i = 0; i < points.size(); ++i) scan.grid->cells.push_back(static_cast<std::int32_t>(i));
  Input input;
  input.add(std::move(scan), Rigid3::Identity());
  input.set_normals([](const Vector3d&) { return Vector3d(Vector3d::UnitZ()); });
  return input;
}

Input nothing() {
  return seen_from_above({}, 0);
}
Input no_scan() {
  return {};
}
Input three_points() {
  return seen_from_above({{0, 0, 0}, {0, pitch, 0}, {pitch, 0, 0}}, 1);
}
Input collinear() {
  std::vector<Vector3d> points;
  for (int i = 0; i < 60; ++i) points.emplace_back(pitch * (i / 2), pitch * (i / 2), 0);
  return seen_from_above(points, 2);
}
Input coplanar() {
  std::vector<Vector3d> points;
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 20; ++column) points.emplace_back(pitch * column, -pitch * row, 7);
  return seen_from_above(points, 20);
}
Input all_duplicate() {
  return seen_from_above(std::vector<Vector3d>(100, {1, 2, 3}), 10);
}
Input all_nan() {
  return seen_from_above(
      std::vector<Vector3d>(100, Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())), 10);
}
Input some_nan() {
  Input input = seen_sphere();
  for (RangeScan& scan : input.scans) scan.cloud.positions[40].x() = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < input.cloud.size(); i += 200)
    input.cloud.positions[i].y() = std::numeric_limits<double>::infinity();
  return input;
}
Input no_normals() {
  Input input = seen_sphere();
  input.cloud.normals.clear();
  for (RangeScan& scan : input.scans) scan.cloud.normals.clear();
  return input;
}
Input normals_flipped() {
  return seen_sphere(-1);
}
Input one_scan_twice() {
  Input input = seen_sphere();
  input.scans.push_back(input.scans[0]);
  input.poses.push_back(input.poses[0]);
  for (std::size_t i = 0; i < input.scans[0].cloud.size(); ++i) {
    input.cloud.positions.push_back(input.cloud.positions[i]);
    input.cloud.normals.push_back(input.cloud.normals[i]);
  }
  return input;
}
Input disjoint_clusters() {
  Input input = seen_sphere();
  Input other = seen_sphere();
  for (Rigid3& pose : other.poses) pose.pretranslate(Vector3d(200, -300, 50));
  for (Vector3d& p : other.cloud.positions) p += Vector3d(200, -300, 50);
  input.scans.insert(input.scans.end(), other.scans.begin(), other.scans.end());
  input.poses.insert(input.poses.end(), other.poses.begin(), other.poses.end());
  input.cloud.positions.insert(input.cloud.positions.end(), other.cloud.positions.begin(),
                               other.cloud.positions.end());
  input.cloud.normals.insert(input.cloud.normals.end(), other.cloud.normals.begin(),
                             other.cloud.normals.end());
  return input;
}

// What becomes of it: a part of the message, or "" for a sound mesh, by method in the order of `methods`.
struct Row {
  std::string name;
  Input (*make)();
  std::array<std::string, methods.size()> message;
  double area;  // of the right result; 0: any
};

const double sphere_area = 4 * std::numbers::pi * radius * radius;

const std::vector<Row>& rows() {
  static const std::vector<Row> all{
      {"no_scan",
       no_scan,
       {"none of the 0", "scans have 0", "scans have 0", "scans have 0", "none of the 0", "scans have 0"},
       0},
      {"nothing",
       nothing,
       {"no surface", "scans have 0", "scans have 0", "scans have 0", "no surface", "no surface"},
       0},
      {"three_points",
       three_points,
       {"no surface", "scans have 3", "scans have 3", "scans have 3", "no surface", "no surface"},
       0},
      {"collinear",
       collinear,
       {"no surface", "on one line", "on one line", "on one line", "no surface", "no surface"},
       0},
      {"coplanar", coplanar, {"", "", "", "", "", ""}, 19 * 19 * pitch * pitch},
      {"all_duplicate",
       all_duplicate,
       {"no surface", "scans have 1", "scans have 1", "scans have 1", "no surface", "no surface"},
       0},
      {"all_nan",
       all_nan,
       {"no surface", "scans have 0", "scans have 0", "scans have 0", "no surface", "no surface"},
       0},
      {"some_nan", some_nan, {"", "", "", "", "", ""}, sphere_area},
      {"no_normals", no_normals, {"", "normals", "", "", "", ""}, sphere_area},
      {"normals_flipped", normals_flipped, {"", "", "", "", "", ""}, sphere_area},
      {"one_scan_twice", one_scan_twice, {"", "", "", "", "", ""}, sphere_area},
      {"disjoint_clusters", disjoint_clusters, {"", "", "", "", "", ""}, 2 * sphere_area},
  };
  return all;
}

class BadScans : public testing::TestWithParam<Row> {};
INSTANTIATE_TEST_SUITE_P(, BadScans, testing::ValuesIn(rows()),
                         [](const auto& row) { return row.param.name; });

TEST_P(BadScans, AreMeshedRightOrRefusedClearly) {
  const Input input = GetParam().make();
  for (std::size_t m = 0; m < methods.size(); ++m) {
    SCOPED_TRACE(fmt::format("method {}", m));
    MeshOptions options;
    options.method = methods[m];
    options.merge_voxel_spacings = 0.5;
    const auto made = [&] { return mesh_scans({input.scans, input.poses, input.cloud, pitch}, options); };
    if (const std::string& expected = GetParam().message[m]; !expected.empty()) {
      const std::string message = test::error_message(ErrorCode::input, [&] { (void)made(); });
      EXPECT_NE(message.find(expected), std::string::npos) << message;
      continue;
    }
    const MeshResult result = made();
    EXPECT_EQ(problem_of(result.mesh), "");
    EXPECT_TRUE(mesh_quality(result.mesh).manifold());
    // Sheets of a grid are not joined: each point is seen by one to three scans. Poisson's surface goes on
    // beyond a rim until it is trimmed.
    const bool sheets = result.method == Method::grid;
    const bool beyond_rim = result.method == Method::poisson && GetParam().area < sphere_area;
    EXPECT_GT(surface_area(result.mesh), 0.85 * GetParam().area);
    EXPECT_LT(surface_area(result.mesh), (sheets ? 3.5 : (beyond_rim ? 2.1 : 1.15)) * GetParam().area);
    if (GetParam().area >= sphere_area && !sheets) {
      EXPECT_GT(signed_volume(result.mesh), 0);
    }
  }
}

// The watertight variant of fusion: a closed mesh round what it makes of them open, or the same refusal.
TEST_P(BadScans, AreCarvedToAClosedMeshOrRefusedClearly) {
  const Input input = GetParam().make();
  MeshOptions options;
  options.method = Method::fusion;
  options.closed = true;
  const auto made = [&] { return mesh_scans({input.scans, input.poses, input.cloud, pitch}, options); };
  // A plane alone has no inside.
  const std::string expected = GetParam().name == "coplanar" ? "it is flat" : GetParam().message[0];
  if (!expected.empty()) {
    const std::string message = test::error_message(ErrorCode::input, [&] { (void)made(); });
    EXPECT_NE(message.find(expected), std::string::npos) << message;
    return;
  }
  const MeshResult result = made();
  EXPECT_EQ(problem_of(result.mesh), "");
  EXPECT_TRUE(mesh_quality(result.mesh).closed());
  EXPECT_GT(surface_area(result.mesh), 0.85 * GetParam().area);
}

// A mesh that is none, and what filling says of it ("": filled to a closed surface, or left as it is).
struct BadMesh {
  std::string name;
  std::function<void(TriangleMesh&)> spoil;
  std::string message;
};

const std::vector<BadMesh>& bad_meshes() {
  static const std::vector<BadMesh> all{
      {"index_out_of_range", [](TriangleMesh& m) { m.faces[3][1] = 1U << 30; }, "face 3"},
      {"nan_vertex", [](TriangleMesh& m) { m.vertices[5].z() = std::numeric_limits<double>::quiet_NaN(); },
       "vertex 5"},
      {"no_faces", [](TriangleMesh& m) { m.faces.clear(); }, ""},
      {"nothing", [](TriangleMesh& m) { m = {}; }, ""},
      {"repeated_corner",
       [](TriangleMesh& m) {
         m.faces.push_back({7, 7, 9});
       },
       ""},
      {"repeated_face", [](TriangleMesh& m) { m.faces.push_back(m.faces[20]); }, ""},
      {"zero_area",
       [](TriangleMesh& m) {
         const Face f = m.faces[40];  // its middle on an edge: two halves, and a cap without area
         m.vertices.push_back((m.vertices[f[0]] + m.vertices[f[1]]) / 2);
         const auto middle = static_cast<std::uint32_t>(m.vertices.size() - 1);
         m.faces[40] = {middle, f[1], f[2]};
         m.faces.push_back({f[0], middle, f[2]});
         m.faces.push_back({f[0], f[1], middle});
       },
       ""},
      {"all_vertices_alike",
       [](TriangleMesh& m) {
         for (Vector3d& v : m.vertices) v.setZero();
       },
       ""},
      {"colors_not_one_per_vertex", [](TriangleMesh& m) { m.colors.resize(3); }, "colours"},
  };
  return all;
}

class BadMeshes : public testing::TestWithParam<BadMesh> {};
INSTANTIATE_TEST_SUITE_P(, BadMeshes, testing::ValuesIn(bad_meshes()),
                         [](const auto& bad) { return bad.param.name; });

TEST_P(BadMeshes, AreFilledAndSimplifiedOrRefusedClearly) {
  TriangleMesh mesh = test::sphere(10, 12);
  GetParam().spoil(mesh);
  FillOptions options;
  options.simplify_triangles = 100;
  if (!GetParam().message.empty()) {
    const auto expect_refused = [](const auto& use) {
      const std::string message = test::error_message(ErrorCode::input, use);
      EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
    };
    expect_refused([&] { (void)fill_holes(mesh, 1, options); });
    expect_refused([&] { (void)simplified(mesh, {50, 0}); });
    expect_refused([&] { (void)mesh_quality(mesh); });
    return;
  }
  const FillResult result = fill_holes(mesh, 1, options);
  EXPECT_EQ(problem_of(result.mesh), "");
  EXPECT_TRUE(mesh_quality(result.mesh).manifold());
  EXPECT_EQ(mesh_quality(result.mesh).boundary_loops, 0U);
  EXPECT_EQ(problem_of(result.simplified), "");
  EXPECT_EQ(problem_of(simplified(mesh, {50, 0})), "");
}

}  // namespace
}  // namespace drape::meshing
