#include "patch_mending.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "drape/geometry/mesh_topology.hpp"
#include "drape/meshing/hole_filling.hpp"
#include "drape/meshing/mesh_quality.hpp"
#include "support.hpp"

namespace drape::meshing {
namespace {

using Eigen::Vector3d;

constexpr int side = 12;  // steps of the patches here

std::uint32_t at(int x, int y) {
  return static_cast<std::uint32_t>(y * (side + 1) + x);
}

// A flat square patch, one spacing a step.
TriangleMesh flat_patch() {
  TriangleMesh patch;
  for (int y = 0; y <= side; ++y)
    for (int x = 0; x <= side; ++x) patch.vertices.emplace_back(x, y, 0);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      patch.faces.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
      patch.faces.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  return patch;
}

// A square below the patch.
std::vector<Face> add_floor(TriangleMesh& mesh, double z) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const double y : {0.3, side - 0.3})
    for (const double x : {0.2, side - 0.2}) mesh.vertices.emplace_back(x, y, z);
  return {{first, first + 1, first + 3}, {first, first + 3, first + 2}};
}

TriangleMesh of_faces(TriangleMesh mesh, const std::vector<Face>& faces) {
  mesh.faces = faces;
  return mesh;
}

// Still a disc with the same border.
void expect_the_same_border(const TriangleMesh& patch, const std::vector<Face>& mended) {
  const TriangleMesh made = of_faces(patch, mended);
  const MeshQuality quality = mesh_quality(made);
  EXPECT_EQ(quality.components, 1U);
  EXPECT_EQ(quality.inconsistent_edges, 0U);
  EXPECT_EQ(quality.non_manifold_edges, 0U);
  const auto loops = boundary_loops(made);
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_EQ(loops[0].vertices.size(), 4U * side);
}

TEST(PatchMending, OnlyWhatDipsThroughTheSurfaceIsTriangulatedAnew) {
  TriangleMesh mesh = flat_patch();
  mesh.vertices[at(5, 6)].z() = -1;
  const std::vector<Face> patch = mesh.faces;
  const std::vector<Face> floor = add_floor(mesh, -0.5);
  const MendedPatch mended = mended_patch(mesh, patch, floor);
  EXPECT_EQ(mended.crossings, 0U);
  expect_the_same_border(mesh, mended.faces);
  const std::set<Face> before(patch.begin(), patch.end());
  const auto kept = std::count_if(mended.faces.begin(), mended.faces.end(),
                                  [&](const Face& f) { return before.count(f) != 0; });
  EXPECT_GE(kept, static_cast<std::ptrdiff_t>(patch.size()) - 6);
}

TEST(PatchMending, WhatARingOfCrossingsEnclosesGoesWithIt) {
  TriangleMesh mesh = flat_patch();
  for (int y = 4; y <= 8; ++y)
    for (int x = 4; x <= 8; ++x)
      if (x == 4 || x == 8 || y == 4 || y == 8) mesh.vertices[at(x, y)].z() = -1;
  const std::vector<Face> patch = mesh.faces;
  const std::vector<Face> floor = add_floor(mesh, -0.5);
  const MendedPatch mended = mended_patch(mesh, patch, floor);
  EXPECT_EQ(mended.crossings, 0U);
  expect_the_same_border(mesh, mended.faces);
}

TEST(PatchMending, WhatCannotBeMendedStays) {
  TriangleMesh mesh = flat_patch();
  const std::vector<Face> patch = mesh.faces;
  // A wall through all of it.
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.emplace_back(-1, 5.3, -1);
  mesh.vertices.emplace_back(side + 1, 5.4, -1);
  mesh.vertices.emplace_back(6, 5.5, 60);
  const MendedPatch mended = mended_patch(mesh, patch, {{first, first + 1, first + 2}});
  EXPECT_GT(mended.crossings, 0U);
  expect_the_same_border(mesh, mended.faces);
}

// A long loop's patch stays smooth where it crosses nothing.
TEST(PatchMending, ASmoothPatchIsGivenUpOnlyWhereItCutsTheSurface) {
  const TriangleMesh sphere = test::sphere(10, 100);
  std::vector<std::uint8_t> keep;
  for (const Face& f : sphere.faces) {
    const Vector3d middle = (sphere.vertices[f[0]] + sphere.vertices[f[1]] + sphere.vertices[f[2]]) / 3;
    // A border that waves is no base.
    keep.push_back(middle.z() < 5 + 2 * std::sin(3 * std::atan2(middle.y(), middle.x())) ? 1 : 0);
  }
  TriangleMesh mesh = with_faces(sphere, keep);
  const double spacing = median_edge_length(mesh);
  const FillResult alone = fill_holes(mesh, spacing, {});
  ASSERT_EQ(alone.holes.size(), 1U);
  ASSERT_GT(alone.holes[0].boundary_edges, 64U);
  const Vector3d top = *std::max_element(alone.mesh.vertices.begin(), alone.mesh.vertices.end(),
                                         [](const Vector3d& a, const Vector3d& b) { return a.z() < b.z(); });
  // A closed speck in the middle of that patch.
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const double angle : {0.1, 2.2, 4.3})
    mesh.vertices.push_back(top + 0.1 * spacing * Vector3d(std::cos(angle), std::sin(angle), 0) -
                            0.001 * spacing * Vector3d::UnitZ());
  mesh.vertices.emplace_back(top + 0.02 * spacing * Vector3d::UnitZ());
  for (const Face& f : {Face{0, 2, 1}, Face{0, 1, 3}, Face{1, 2, 3}, Face{2, 0, 3}})
    mesh.faces.push_back({first + f[0], first + f[1], first + f[2]});
  FillOptions options;
  options.max_hole_size_spacings = 400;
  const FillResult result = fill_holes(mesh, spacing, options);
  EXPECT_EQ(result.self_intersections, 0U);
  ASSERT_EQ(result.holes.size(), 1U);
  EXPECT_EQ(result.holes[0].action, HoleAction::fair);
  EXPECT_NE(result.holes[0].why.find("triangulated anew where it cut the surface"), std::string::npos)
      << result.holes[0].why;
  EXPECT_GT(result.holes[0].faces_added, alone.holes[0].faces_added * 9 / 10);
}

}  // namespace
}  // namespace drape::meshing
