#include "drape/meshing/hole_filling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "drape/base/parallel.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "drape/meshing/mesh_quality.hpp"
#include "shapes.hpp"
#include "support.hpp"

namespace drape::meshing {
namespace {

using std::numbers::pi;

FillResult fill(const TriangleMesh& mesh, const FillOptions& options = {}) {
  return fill_holes(mesh, median_edge_length(mesh), options);
}

// The input is the beginning of the result, bit by bit; what follows is marked.
void expect_untouched(const TriangleMesh& before, const TriangleMesh& after) {
  ASSERT_LE(before.vertices.size(), after.vertices.size());
  ASSERT_LE(before.faces.size(), after.faces.size());
  ASSERT_EQ(after.filled.size(), after.faces.size());
  for (std::size_t v = 0; v < before.vertices.size(); ++v) ASSERT_EQ(before.vertices[v], after.vertices[v]);
  for (std::size_t i = 0; i < before.faces.size(); ++i) ASSERT_EQ(before.faces[i], after.faces[i]);
  for (std::size_t i = 0; i < after.faces.size(); ++i)
    ASSERT_EQ(after.filled[i], i < before.faces.size() ? 0 : 1) << i;
}

TEST(HoleFilling, ASphereGetsItsCapBack) {
  const TriangleMesh whole = test::sphere(10, 40);
  const TriangleMesh open = test::with_hole(whole, [](const Eigen::Vector3d& p) { return p.z() > 9; });
  const FillResult result = fill(open);
  expect_untouched(open, result.mesh);
  ASSERT_EQ(result.holes.size(), 1U);
  const Hole& hole = result.holes[0];
  EXPECT_TRUE(hole.filled());
  EXPECT_EQ(hole.boundary_edges, 80U);
  EXPECT_EQ(hole.faces_added, result.mesh.faces.size() - open.faces.size());
  EXPECT_NEAR(hole.length, 2 * pi * std::sqrt(100 - hole.center.z() * hole.center.z()), 0.1);
  EXPECT_NEAR(hole.area, pi * (100 - hole.center.z() * hole.center.z()), 0.5);
  EXPECT_NE(hole.why.find("faired"), std::string::npos);
  EXPECT_TRUE(mesh_topology(result.mesh).closed_manifold());
  EXPECT_EQ(mesh_quality(result.mesh).genus, 0);
  EXPECT_EQ(result.self_intersections, 0U);
  // The cap is 1 high; a planar fill would be that far off, the faired one follows the sphere.
  EXPECT_LT(test::worst_distance(result.mesh, [](const Eigen::Vector3d& p) { return p.norm() - 10; }), 0.25);
  EXPECT_NEAR(signed_volume(result.mesh), signed_volume(whole), 5);
}

TEST(HoleFilling, TheLimitIsRespected) {
  TriangleMesh open = test::with_hole(test::sphere(10, 40), [](const Eigen::Vector3d& p) {
    return p.z() > 9.5 || (p - Eigen::Vector3d(10, 0, 0)).norm() < 1.5;
  });
  const double spacing = median_edge_length(open);
  FillOptions options;
  options.max_hole_size_spacings = 2 * pi * 2 / spacing;  // between the two
  const FillResult result = fill(open, options);
  ASSERT_EQ(result.holes.size(), 2U);
  for (const Hole& hole : result.holes) {
    EXPECT_EQ(hole.filled(), hole.length < options.max_hole_size_spacings * spacing);
    EXPECT_NE(hole.why.find(hole.filled() ? "shorter than max_hole_size_spacings" : "not shorter than"),
              std::string::npos);
  }
  EXPECT_NE(result.holes[0].filled(), result.holes[1].filled());
  EXPECT_EQ(mesh_topology(result.mesh).boundary_loops, 1U);
  options.max_hole_size_spacings = 0;
  EXPECT_EQ(fill(open, options).mesh.faces, open.faces);
}

TEST(HoleFilling, TheRimOfASheetStaysOpen) {
  TriangleMesh sheet;
  for (std::uint32_t y = 0; y < 20; ++y)
    for (std::uint32_t x = 0; x < 20; ++x) {
      sheet.vertices.emplace_back(x, y, 0.1 * x * y);
      if (x + 1 == 20 || y + 1 == 20 || (x == 7 && y == 7)) continue;
      const std::uint32_t v = y * 20 + x;
      sheet.faces.push_back({v, v + 1, v + 20});
      sheet.faces.push_back({v + 1, v + 21, v + 20});
    }
  FillResult result = fill(sheet);
  ASSERT_EQ(result.holes.size(), 2U);
  EXPECT_EQ(result.holes[0].why, "outer border of an open sheet");
  EXPECT_FALSE(result.holes[0].filled());
  EXPECT_TRUE(result.holes[1].filled());
  FillOptions options;
  options.keep_outer_border = false;
  result = fill(sheet, options);
  EXPECT_TRUE(mesh_topology(result.mesh).closed_manifold());
}

TEST(HoleFilling, ABorderThatTouchesItselfIsFilledAsTwo) {
  // Two neighbouring vertices' fans are cut out, but for the two faces between them meet in a point.
  TriangleMesh mesh = test::sphere(10, 16);
  std::vector<std::uint8_t> keep(mesh.faces.size(), 1);
  const Face seed = mesh.faces[300];
  std::vector<std::uint32_t> ring;
  for (std::size_t i = 0; i < keep.size(); ++i) {
    const Face& f = mesh.faces[i];
    if (std::find(f.begin(), f.end(), seed[0]) != f.end()) ring.push_back(static_cast<std::uint32_t>(i));
  }
  ASSERT_EQ(ring.size(), 6U);
  keep[ring[0]] = 0;
  for (const std::uint32_t other : ring) {  // one across: it shares the hub and nothing else
    int shared = 0;
    for (const std::uint32_t v : mesh.faces[other])
      shared += static_cast<int>(std::count(mesh.faces[ring[0]].begin(), mesh.faces[ring[0]].end(), v));
    if (shared == 1) {
      keep[other] = 0;
      break;
    }
  }
  const TriangleMesh open = with_faces(mesh, keep);
  EXPECT_EQ(mesh_quality(open).non_manifold_vertices, 1U);
  const FillResult result = fill(open);
  expect_untouched(open, result.mesh);
  ASSERT_EQ(result.holes.size(), 2U);
  for (const Hole& hole : result.holes) EXPECT_TRUE(hole.filled());
  EXPECT_EQ(result.mesh.vertices.size(), mesh.vertices.size());
  EXPECT_EQ(result.mesh.faces.size(), mesh.faces.size());
  EXPECT_TRUE(mesh_quality(result.mesh).closed());
}

TEST(HoleFilling, ABowTieIsPartedAndClosed) {
  TriangleMesh ties;  // two open boxes that touch in one corner
  for (const double side : {0.0, 1.0}) {
    const TriangleMesh box = test::box(Eigen::Vector3d::Constant(side), Eigen::Vector3d::Constant(side + 1));
    const auto offset = static_cast<std::uint32_t>(ties.vertices.size());
    ties.vertices.insert(ties.vertices.end(), box.vertices.begin(), box.vertices.end());
    for (std::size_t i = 2; i < box.faces.size(); ++i)
      ties.faces.push_back({box.faces[i][0] + offset, box.faces[i][1] + offset, box.faces[i][2] + offset});
  }
  for (Face& f : ties.faces)
    for (std::uint32_t& v : f)
      if (v == 8) v = 7;  // the second's least corner is the first's greatest
  const TriangleMesh open = without_unused_vertices(ties);
  EXPECT_EQ(mesh_quality(open).non_manifold_vertices, 1U);
  const FillResult result = fill(open);
  EXPECT_EQ(result.non_manifold_repaired, 1U);
  const MeshQuality quality = mesh_quality(result.mesh);
  EXPECT_TRUE(quality.closed());
  EXPECT_EQ(quality.components, 2U);
  EXPECT_NEAR(*quality.volume, 2, 1e-9);
}

TEST(HoleFilling, ATriangleAndATetrahedronWithoutAFace) {
  TriangleMesh tetrahedron;
  tetrahedron.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  tetrahedron.faces = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  FillOptions options;
  options.keep_outer_border = false;
  const FillResult result = fill(tetrahedron, options);
  EXPECT_EQ(result.mesh.faces.size(), 4U);
  EXPECT_TRUE(mesh_quality(result.mesh).closed());
  EXPECT_NEAR(signed_volume(result.mesh), 1.0 / 6, 1e-12);
}

TEST(HoleFilling, LongLoopsCostABoundedTime) {
  const TriangleMesh open =
      test::with_hole(test::sphere(10, 350), [](const Eigen::Vector3d& p) { return p.z() > 9; });
  FillOptions options;
  options.max_hole_size_spacings = 1e6;
  options.simplify_triangles = 0;
  const FillResult result = fill(open, options);
  ASSERT_EQ(result.holes.size(), 1U);
  EXPECT_EQ(result.holes[0].boundary_edges, 700U);
  EXPECT_NE(result.holes[0].why.find("coarser"), std::string::npos);
  EXPECT_LT(result.holes[0].faces_added, 40000U);
  EXPECT_TRUE(mesh_topology(result.mesh).closed_manifold());
}

TEST(HoleFilling, AttributesAreBlendedFromTheBoundary) {
  TriangleMesh open =
      test::with_hole(test::sphere(10, 40), [](const Eigen::Vector3d& p) { return p.z() > 9; });
  for (const Eigen::Vector3d& p : open.vertices) {
    open.colors.push_back(p.x() > 0 ? Eigen::Vector3f(1, 0, 0) : Eigen::Vector3f(0, 1, 0));
    open.intensities.push_back(0.25F);
    open.confidences.push_back(1);
  }
  open.normals = vertex_normals(open);
  const TriangleMesh mesh = fill(open).mesh;
  ASSERT_EQ(problem_of(mesh), "");
  for (std::size_t v = 0; v < open.vertices.size(); ++v) EXPECT_EQ(mesh.normals[v], open.normals[v]);
  for (std::size_t v = open.vertices.size(); v < mesh.vertices.size(); ++v) {
    EXPECT_NEAR(mesh.colors[v].sum(), 1, 1e-5);
    EXPECT_GT(mesh.colors[v].x(), mesh.vertices[v].x() > 2 ? 0.6 : 0);
    EXPECT_NEAR(mesh.intensities[v], 0.25, 1e-5);
    EXPECT_EQ(mesh.confidences[v], 0);
    EXPECT_GT(mesh.normals[v].cast<double>().dot(mesh.vertices[v].normalized()), 0.95);
  }
}

TEST(HoleFilling, RepairsWhatIsNoSurface) {
  TriangleMesh mesh = test::sphere(10, 24);
  const TriangleMesh whole = mesh;
  mesh.faces.push_back({5, 5, 9});                                                     // degenerate
  mesh.faces.push_back({mesh.faces[100][1], mesh.faces[100][0], mesh.faces[100][2]});  // reversed
  FillResult result = fill(mesh);
  EXPECT_EQ(result.bad_faces_removed, 2U);
  EXPECT_EQ(result.mesh.faces, whole.faces);

  mesh = whole;  // a fin on an edge
  mesh.vertices.emplace_back(0, 0, 15);
  mesh.faces.push_back(
      {mesh.faces[10][0], mesh.faces[10][1], static_cast<std::uint32_t>(mesh.vertices.size() - 1)});
  result = fill(mesh);
  EXPECT_GT(result.non_manifold_repaired, 0U);
  EXPECT_TRUE(mesh_quality(result.mesh).manifold());

  mesh = whole;  // a face that is inside out
  std::swap(mesh.faces[50][0], mesh.faces[50][1]);
  result = fill(mesh);
  EXPECT_TRUE(mesh_quality(result.mesh).closed());
  EXPECT_NEAR(signed_volume(result.mesh), signed_volume(whole), 1e-9);
}

TEST(HoleFilling, JoinsBordersWithTheSameCoordinates) {
  const TriangleMesh whole = test::sphere(10, 24);
  TriangleMesh split;  // every face with corners of its own
  for (const Face& f : whole.faces) {
    const auto first = static_cast<std::uint32_t>(split.vertices.size());
    for (const std::uint32_t v : f) split.vertices.push_back(whole.vertices[v]);
    split.faces.push_back({first, first + 1, first + 2});
  }
  const FillResult result = fill(split);
  EXPECT_TRUE(result.holes.empty());
  EXPECT_EQ(result.mesh.vertices.size(), whole.vertices.size());
  EXPECT_EQ(result.vertices_joined, split.vertices.size() - whole.vertices.size());
}

TEST(HoleFilling, FacesWithoutAreaDoNotStopIt) {
  TriangleMesh open =
      test::with_hole(test::sphere(10, 24), [](const Eigen::Vector3d& p) { return p.z() > 8; });
  const Face last =
      open.faces.back();  // split it at the middle of an edge: a cap without area, with its own corners
  open.vertices.push_back((open.vertices[last[0]] + open.vertices[last[1]]) / 2);
  const auto middle = static_cast<std::uint32_t>(open.vertices.size() - 1);
  open.faces.back() = {middle, last[1], last[2]};
  open.faces.push_back({last[0], middle, last[2]});
  open.faces.push_back({last[0], last[1], middle});
  const FillResult result = fill(open);
  EXPECT_TRUE(mesh_quality(result.mesh).closed());
}

std::size_t faces_without_area(const TriangleMesh& mesh) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i)
    count += scaled_face_normal(mesh, i).norm() > 1e-12 ? 0 : 1;
  return count;
}

// Parts the edge between the first two corners of a face in its middle on that face's side only: a face
// without area lies between.
void part_on_one_side(TriangleMesh& mesh, std::size_t face) {
  const Face f = mesh.faces[face];
  mesh.vertices.push_back((mesh.vertices[f[0]] + mesh.vertices[f[1]]) / 2);
  const auto middle = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  mesh.faces[face] = {middle, f[1], f[2]};
  mesh.faces.push_back({f[0], middle, f[2]});
  mesh.faces.push_back({f[0], f[1], middle});
}

// The first corner of a face becomes two vertices in one place: this face and the one across its last edge
// take the new one, and two faces without area lie between the two.
void part_vertex(TriangleMesh& mesh, std::uint32_t face) {
  const auto [old, right, middle] = mesh.faces[face];
  mesh.vertices.push_back(mesh.vertices[old]);
  const auto twin = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  std::uint32_t left = right;
  for (Face& f : mesh.faces)
    for (int turn = 0; turn < 3; ++turn) {
      std::rotate(f.begin(), f.begin() + 1, f.end());
      if (f[0] == old && f[1] == middle) left = f[2];
    }
  for (Face& f : mesh.faces)
    if (std::count(f.begin(), f.end(), middle) != 0) std::replace(f.begin(), f.end(), old, twin);
  mesh.faces.push_back({twin, old, right});
  mesh.faces.push_back({old, twin, left});
}

TEST(HoleFilling, RepairLeavesNoFaceWithoutArea) {
  const TriangleMesh whole = test::sphere(10, 24);
  TriangleMesh mesh = whole;
  part_on_one_side(mesh, 300);
  part_on_one_side(mesh, mesh.faces.size() - 2);  // a half of it once more
  part_vertex(mesh, 100);
  ASSERT_TRUE(mesh_topology(mesh).closed_manifold());
  ASSERT_EQ(faces_without_area(mesh), 4U);

  const FillResult result = fill(mesh);
  EXPECT_EQ(faces_without_area(result.mesh), 0U);
  EXPECT_EQ(result.bad_faces_removed, 4U);
  EXPECT_TRUE(mesh_quality(result.mesh).closed());
  EXPECT_EQ(result.mesh.vertices.size(), whole.vertices.size() + 2);
  EXPECT_NEAR(signed_volume(result.mesh), signed_volume(whole), 1e-9);
  FillOptions as_it_is;
  as_it_is.repair = false;
  EXPECT_EQ(faces_without_area(fill(mesh, as_it_is).mesh), 4U);
}

TEST(HoleFilling, AFaceWithoutAreaThatHangsOnABorderGoes) {
  const TriangleMesh open =
      test::with_hole(test::sphere(10, 24), [](const Eigen::Vector3d& p) { return p.z() > 8; });
  const std::vector<std::uint32_t> loop = boundary_loops(open).at(0).vertices;
  TriangleMesh with_spike = open;
  with_spike.vertices.emplace_back(2 * open.vertices[loop[3]] - open.vertices[loop[4]]);
  // The hole is on the left of its loop.
  with_spike.faces.push_back({loop[4], loop[3], static_cast<std::uint32_t>(with_spike.vertices.size() - 1)});
  ASSERT_EQ(faces_without_area(with_spike), 1U);
  FillOptions open_still;
  open_still.max_hole_size_spacings = 0;
  EXPECT_EQ(fill(with_spike, open_still).mesh.faces, open.faces);
}

TEST(HoleFilling, UnsoundInputIsNamed) {
  TriangleMesh mesh = test::sphere(10, 8);
  mesh.faces[3][1] = 999999;
  EXPECT_NE(test::error_message(ErrorCode::input, [&] { (void)fill_holes(mesh, 1, {}); }).find("face 3"),
            std::string::npos);
  mesh = test::sphere(10, 8);
  mesh.vertices[5].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(test::error_message(ErrorCode::input, [&] { (void)fill_holes(mesh, 1, {}); }).find("vertex 5"),
            std::string::npos);
  EXPECT_NE(test::error_message(ErrorCode::input, [&] { (void)fill_holes(test::sphere(1), 0, {}); })
                .find("spacing"),
            std::string::npos);
  EXPECT_TRUE(fill_holes({}, 1, {}).mesh.empty());
}

TEST(HoleFilling, WithoutRepairInconsistentLoopsStayOpenAndSaySo) {
  TriangleMesh mesh = test::sphere(10, 24);
  std::swap(mesh.faces[50][0], mesh.faces[50][1]);
  FillOptions options;
  options.repair = false;
  const FillResult result = fill(mesh, options);
  EXPECT_EQ(result.mesh.faces, mesh.faces);
  for (const Hole& hole : result.holes) EXPECT_NE(hole.why.find("inconsistent"), std::string::npos);
}

TEST(HoleFilling, ThreadsDoNotMatter) {
  const TriangleMesh open = test::with_hole(test::torus(10, 4, 96, 48), [](const Eigen::Vector3d& p) {
    return std::fmod(std::abs(p.x()), 3) < 0.7 && std::fmod(std::abs(p.y()), 3) < 0.7;
  });
  const TriangleMesh many = fill(open).mesh;
  set_thread_count(1);
  const TriangleMesh one = fill(open).mesh;
  set_thread_count(0);
  EXPECT_GT(many.faces.size(), open.faces.size());
  ASSERT_EQ(one.faces, many.faces);
  for (std::size_t v = 0; v < one.vertices.size(); ++v) EXPECT_EQ(one.vertices[v], many.vertices[v]);
}

}  // namespace
}  // namespace drape::meshing
