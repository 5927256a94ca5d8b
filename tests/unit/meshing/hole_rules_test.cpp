// Which holes are filled, and how: bases, islands, hollow rims, and space that a scanner looked through.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "drape/geometry/mesh_topology.hpp"
#include "drape/meshing/hole_filling.hpp"
#include "drape/meshing/mesh_quality.hpp"
#include "shapes.hpp"
#include "support.hpp"

namespace drape::meshing {
namespace {

using std::numbers::pi;

FillResult fill(const TriangleMesh& mesh, const FillOptions& options = {}, const PlacedScans& scans = {}) {
  return fill_holes(mesh, median_edge_length(mesh), options, scans);
}

// A tall egg, cut off below: it stands on a flat rim.
TriangleMesh standing_egg(double size = 1, double cut = -0.3) {
  TriangleMesh egg =
      test::with_hole(test::sphere(10, 40), [&](const Eigen::Vector3d& p) { return p.z() < 10 * cut; });
  for (Eigen::Vector3d& p : egg.vertices) p = size * Eigen::Vector3d(p.x(), p.y(), 3 * p.z());
  return egg;
}

TriangleMesh turned_inside_out(TriangleMesh mesh) {
  for (Face& f : mesh.faces) std::swap(f[1], f[2]);
  return mesh;
}

TriangleMesh together(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh both = a;
  const auto offset = static_cast<std::uint32_t>(a.vertices.size());
  both.vertices.insert(both.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Face& f : b.faces) both.faces.push_back({f[0] + offset, f[1] + offset, f[2] + offset});
  return both;
}

TEST(HoleRules, ABaseGetsAPlane) {
  const TriangleMesh egg = standing_egg();
  FillOptions options;
  options.max_hole_size_spacings = 40;  // shorter than the rim: a plane is safe at any size
  const FillResult result = fill(egg, options);
  ASSERT_EQ(result.holes.size(), 1U);
  EXPECT_EQ(result.holes[0].action, HoleAction::flat);
  EXPECT_GT(result.holes[0].length, 40 * median_edge_length(egg));
  EXPECT_NEAR(result.holes[0].flatness, 0, 1e-9);
  EXPECT_EQ(result.holes[0].faces_added, result.holes[0].boundary_edges - 2);
  EXPECT_TRUE(mesh_quality(result.mesh).closed());
  EXPECT_EQ(result.mesh.vertices.size(), egg.vertices.size());

  options.base = Base::leave;
  const FillResult left = fill(egg, options);
  EXPECT_EQ(left.holes[0].action, HoleAction::leave);
  EXPECT_EQ(left.holes[0].why, "a flat base");
  EXPECT_EQ(left.mesh.faces, egg.faces);
}

// A tube of unit cells, closed above; of the lowest row every other cell is missing.
TriangleMesh tube_with_battlements(std::uint32_t around = 60, std::uint32_t rows = 40) {
  TriangleMesh tube;
  const double radius = around / (2 * pi);
  for (std::uint32_t row = 0; row <= rows; ++row)
    for (std::uint32_t i = 0; i < around; ++i)
      tube.vertices.emplace_back(radius * std::cos(2 * pi * i / around),
                                 radius * std::sin(2 * pi * i / around), row);
  const auto apex = static_cast<std::uint32_t>(tube.vertices.size());
  tube.vertices.emplace_back(0, 0, rows);
  for (std::uint32_t row = 0; row < rows; ++row)
    for (std::uint32_t i = row == 0 ? 1 : 0; i < around; i += row == 0 ? 2 : 1) {
      const std::uint32_t a = row * around + i;
      const std::uint32_t b = row * around + (i + 1) % around;
      tube.faces.push_back({a, b, b + around});
      tube.faces.push_back({a, b + around, a + around});
    }
  for (std::uint32_t i = 0; i < around; ++i)
    tube.faces.push_back({rows * around + i, rows * around + (i + 1) % around, apex});
  return tube;
}

TEST(HoleRules, ABaseWithAJaggedRimIsABase) {
  const TriangleMesh tube = tube_with_battlements();
  const FillResult result = fill(tube);
  ASSERT_EQ(result.holes.size(), 1U);
  EXPECT_EQ(result.holes[0].why.rfind("a base; ", 0), 0U) << result.holes[0].why;
  EXPECT_EQ(result.mesh.vertices.size(), tube.vertices.size());  // nothing bulges out below
  EXPECT_TRUE(mesh_quality(result.mesh).closed());
}

TEST(HoleRules, AShallowHoleIsNoBase) {
  const TriangleMesh open =
      test::with_hole(test::sphere(10, 40), [](const Eigen::Vector3d& p) { return p.z() > 8.5; });
  for (const Base base : {Base::automatic, Base::leave}) {
    FillOptions options;
    options.base = base;
    EXPECT_EQ(fill(open, options).holes[0].action, HoleAction::fair);
  }
}

TEST(HoleRules, TheLongestBorderIsCappedWhenAsked) {
  // Half a sphere: an open sheet as far as anyone can tell.
  const TriangleMesh half =
      test::with_hole(test::sphere(10, 40), [](const Eigen::Vector3d& p) { return p.z() < 0; });
  EXPECT_EQ(fill(half).holes[0].why, "outer border of an open sheet");
  FillOptions options;
  options.base = Base::flat;
  const FillResult result = fill(half, options);
  EXPECT_EQ(result.holes[0].action, HoleAction::flat);
  const MeshQuality quality = mesh_quality(result.mesh);
  ASSERT_TRUE(quality.closed());
  EXPECT_NEAR(*quality.volume, 2 * pi / 3 * 1000, 15);
}

TEST(HoleRules, AHollowBaseBecomesARing) {
  const TriangleMesh outer = standing_egg();
  TriangleMesh inner = turned_inside_out(standing_egg(0.8));
  const double lowest =
      std::min_element(outer.vertices.begin(), outer.vertices.end(), [](const auto& a, const auto& b) {
        return a.z() < b.z();
      })->z();
  for (Eigen::Vector3d& p : inner.vertices) p.z() += 0.2 * lowest;
  const FillResult result = fill(together(outer, inner));
  ASSERT_EQ(result.holes.size(), 2U);
  for (const Hole& hole : result.holes) EXPECT_EQ(hole.action, HoleAction::flat) << hole.why;
  const MeshQuality quality = mesh_quality(result.mesh);
  ASSERT_TRUE(quality.closed());
  EXPECT_EQ(quality.components, 1U);
  EXPECT_EQ(quality.genus, 0);
  EXPECT_EQ(quality.self_intersections, 0U);
  FillOptions options;
  options.base = Base::flat;
  const double whole = *mesh_quality(fill(outer, options).mesh).volume;
  EXPECT_NEAR(*quality.volume, whole * (1 - std::pow(0.8, 3)), 1e-6 * whole);
}

TEST(HoleRules, AnIslandIsJoinedToTheSurfaceRoundIt) {
  const TriangleMesh ring = test::with_hole(
      test::sphere(10, 60), [](const Eigen::Vector3d& p) { return p.z() > 8.2 && p.z() < 9.6; });
  EXPECT_EQ(mesh_quality(ring).components, 2U);
  const FillResult result = fill(ring);
  ASSERT_EQ(result.holes.size(), 2U);
  for (const Hole& hole : result.holes) EXPECT_TRUE(hole.filled()) << hole.why;
  const MeshQuality quality = mesh_quality(result.mesh);
  ASSERT_TRUE(quality.closed());
  EXPECT_EQ(quality.components, 1U);
  EXPECT_EQ(quality.genus, 0);
  EXPECT_EQ(quality.self_intersections, 0U);
  EXPECT_LT(test::worst_distance(result.mesh, [](const Eigen::Vector3d& p) { return p.norm() - 10; }), 0.25);
  FillOptions options;
  options.max_hole_size_spacings = 20;
  for (const Hole& hole : fill(ring, options).holes) EXPECT_FALSE(hole.filled());
}

TEST(HoleRules, TheRimOfASheetRunsRoundItsHolesAndStaysApart) {
  // Seen from above the rim runs the other way round all the holes, in one plane with them.
  constexpr std::uint32_t side = 13;
  TriangleMesh sheet;
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      sheet.vertices.emplace_back(x, y, 0);
      if (x + 1 == side || y + 1 == side || (x % 4 == 2 && y % 4 == 2)) continue;
      const std::uint32_t v = y * side + x;
      sheet.faces.push_back({v, v + 1, v + side});
      sheet.faces.push_back({v + 1, v + side + 1, v + side});
    }
  const FillResult result = fill(sheet);
  ASSERT_EQ(result.holes.size(), 10U);
  for (const Hole& hole : result.holes) EXPECT_EQ(hole.filled(), hole.boundary_edges == 4U) << hole.why;
  EXPECT_EQ(mesh_topology(result.mesh).boundary_loops, 1U);
}

TEST(HoleRules, TheTwoMouthsOfATubeAreFilledApart) {
  // Seen along it, one lies inside the other and runs the other way round: but it is far off.
  TriangleMesh tube =
      test::with_hole(test::sphere(10, 40), [](const Eigen::Vector3d& p) { return p.z() > 8 || p.z() < -9; });
  for (Eigen::Vector3d& p : tube.vertices) p.z() *= 4;
  const FillResult result = fill(tube);
  const MeshQuality quality = mesh_quality(result.mesh);
  EXPECT_TRUE(quality.closed());
  EXPECT_EQ(quality.genus, 0);
}

// A sphere open above, and a scan from above of a square lattice at the height `z`.
struct SeenFromAbove {
  TriangleMesh open;
  std::vector<RangeScan> scans;
  std::vector<Rigid3> poses;

  SeenFromAbove(double z, double half_width, ScanView::Kind kind)
      : open(test::with_hole(test::sphere(10, 100), [](const Eigen::Vector3d& p) { return p.z() > 7.5; })),
        scans(1),
        poses{Rigid3(Eigen::Translation3d(5, -3, 2))} {
    const double spacing = median_edge_length(open);
    for (double x = -half_width; x <= half_width; x += spacing)
      for (double y = -half_width; y <= half_width; y += spacing)
        scans[0].cloud.positions.push_back(poses[0].inverse() * Eigen::Vector3d(x, y, z));
    scans[0].view.kind = kind;
    scans[0].view.vector = kind == ScanView::Kind::direction
                               ? Eigen::Vector3d(0, 0, -1)
                               : poses[0].inverse() * Eigen::Vector3d(0, 0, 500);
  }
  [[nodiscard]] Hole hole(const FillOptions& options = {}) const {
    return fill(open, options, {scans, poses}).holes.at(0);
  }
};

TEST(HoleRules, WhatWasSeenThroughStaysOpen) {
  for (const ScanView::Kind kind : {ScanView::Kind::direction, ScanView::Kind::origin}) {
    const SeenFromAbove down_to_the_bottom(-9, 5, kind);
    const Hole hole = down_to_the_bottom.hole();
    EXPECT_EQ(hole.action, HoleAction::leave);
    EXPECT_NE(hole.why.find("a scanner looked through"), std::string::npos) << hole.why;
    FillOptions options;
    options.keep_seen_space_open = false;
    EXPECT_EQ(down_to_the_bottom.hole(options).action, HoleAction::fair);
  }
  // Without a view there are no rays.
  EXPECT_EQ(SeenFromAbove(-9, 5, ScanView::Kind::unknown).hole().action, HoleAction::fair);
  // A ray or two at the edge of the hole are no proof.
  EXPECT_EQ(SeenFromAbove(-9, 0.4, ScanView::Kind::direction).hole().action, HoleAction::fair);
  // What is seen in front of the hole says nothing of what is behind it.
  EXPECT_EQ(SeenFromAbove(15, 5, ScanView::Kind::direction).hole().action, HoleAction::fair);
}

TEST(HoleRules, APatchStaysBehindWhatWasSeen) {
  // Samples just above the hole's plane: the bulge of a fair patch would hide them, a plain one does not.
  const Hole hole = SeenFromAbove(7.6, 5, ScanView::Kind::direction).hole();
  EXPECT_EQ(hole.action, HoleAction::plain) << hole.why;
}

// A flat sheet with a hole like a T: a bar, and a stem down from its middle.
struct SheetWithT {
  static constexpr double stem_end = 30;
  TriangleMesh sheet;

  SheetWithT() {
    const auto at = [](int x, int y) { return static_cast<std::uint32_t>((y + 40) * 61 + x + 30); };
    for (int y = -40; y <= 20; ++y)
      for (int x = -30; x <= 30; ++x) sheet.vertices.emplace_back(x, y, 0);
    for (int y = -40; y < 20; ++y)
      for (int x = -30; x < 30; ++x) {
        const bool bar = std::abs(x + 0.5) < 24 && y >= 0 && y < 4;
        const bool stem = std::abs(x + 0.5) < 2 && y >= -stem_end && y < 0;
        if (bar || stem) continue;
        sheet.faces.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
        sheet.faces.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
      }
    sheet = without_unused_vertices(sheet);
  }
  /// What becomes of the hole where a scan from above sees a floor through so much of the stem's end.
  [[nodiscard]] Hole seen_through(double length) const {
    std::vector<RangeScan> scans(1);
    for (double x = -3; x <= 3; x += 0.5)
      for (double y = -stem_end - 1; y <= -stem_end + length; y += 0.5)
        scans[0].cloud.positions.emplace_back(x, y, -10);
    scans[0].view.kind = ScanView::Kind::direction;
    scans[0].view.vector = Eigen::Vector3d(0, 0, -1);
    const std::vector<Rigid3> poses{Rigid3::Identity()};
    const std::vector<Hole> holes = fill(sheet, {}, {scans, poses}).holes;
    return *std::min_element(holes.begin(), holes.end(),
                             [](const Hole& a, const Hole& b) { return a.length < b.length; });
  }
};

TEST(HoleRules, APatchThatWastesAreaIsNoBetterForIt) {
  const SheetWithT t;
  EXPECT_EQ(t.seen_through(2).action, HoleAction::fair);
  // More than a tenth of the hole. A fan from its middle folds over itself beside the bar: its faces have
  // twice the area, of which less than a tenth is here.
  const Hole hole = t.seen_through(10);
  EXPECT_EQ(hole.action, HoleAction::leave);
  EXPECT_NE(hole.why.find("a scanner looked through"), std::string::npos) << hole.why;
}

TEST(HoleRules, ALongHoleThatNoPatchClosesWithoutCuttingTheSurfaceStaysOpen) {
  const TriangleMesh open =
      test::with_hole(test::sphere(10, 100), [](const Eigen::Vector3d& p) { return p.z() > 7.5; });
  const FillResult alone = fill(open);
  ASSERT_EQ(alone.holes.size(), 1U);
  ASSERT_GT(alone.holes[0].boundary_edges, 64U);
  EXPECT_EQ(alone.holes[0].action, HoleAction::fair);
  // A ball in the hole's mouth.
  const TriangleMesh blocked = together(open, test::sphere(4, 30, {0, 0, 8}));
  const FillResult result = fill(blocked);
  ASSERT_EQ(result.holes.size(), 1U);
  EXPECT_EQ(result.holes[0].action, HoleAction::leave);
  EXPECT_NE(result.holes[0].why.find("would cut the surface"), std::string::npos) << result.holes[0].why;
  EXPECT_EQ(result.self_intersections, 0U);
  EXPECT_EQ(result.mesh.faces, blocked.faces);
}

TEST(HoleRules, TinyMeshesEndWell) {
  TriangleMesh triangle;
  triangle.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.faces = {{0, 1, 2}};
  EXPECT_EQ(fill(triangle).holes.at(0).why, "outer border of an open sheet");
  TriangleMesh line;  // no area at all
  line.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  line.faces = {{0, 1, 2}, {1, 3, 2}};
  for (const Hole& hole : fill(line).holes) EXPECT_FALSE(hole.why.empty());
  TriangleMesh point;  // all vertices alike
  point.vertices.assign(6, {1, 2, 3});
  point.faces = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_TRUE(fill_holes(point, 1, {}).mesh.empty());
}

}  // namespace
}  // namespace drape::meshing
