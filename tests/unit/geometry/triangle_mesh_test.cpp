#include "drape/geometry/triangle_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <set>

#include "drape/geometry/barycentric.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "support.hpp"

namespace drape {
namespace {

TEST(TriangleMesh, BoxHasItsAreaAndVolume) {
  const TriangleMesh mesh = test::box({1000, 0, 0}, {1001, 2, 3});
  EXPECT_DOUBLE_EQ(surface_area(mesh), 22.0);
  EXPECT_DOUBLE_EQ(signed_volume(mesh), 6.0);
}

TEST(TriangleMesh, BarycentricWeightsSayWhereAPointIs) {
  const TriangleMesh mesh{.vertices = {{0, 0, 1}, {4, 0, 1}, {0, 2, 1}, {4, 0, 1}},
                          .faces = {{0, 1, 2}, {1, 3, 1}}};
  const auto at = [&](double x, double y, double z) { return barycentric_weights(mesh, 0, {x, y, z}); };
  EXPECT_TRUE(at(4, 0, 1).isApprox(Eigen::Vector3d(0, 1, 0)));
  EXPECT_TRUE(at(1, 1, 1).isApprox(Eigen::Vector3d(0.25, 0.25, 0.5)));
  EXPECT_TRUE(at(1, 1, 7).isApprox(Eigen::Vector3d(0.25, 0.25, 0.5))) << "off the plane: of its foot";
  EXPECT_LT(at(4, 2, 1)[0], 0) << "beyond the opposite edge";
  EXPECT_TRUE(barycentric_weights(mesh, 1, {9, 9, 9}).isApprox(Eigen::Vector3d::Constant(1.0 / 3)));
}

TEST(TriangleMesh, SphereNormalsPointOutwards) {
  const TriangleMesh mesh = test::sphere(2, 24, {5, 5, 5});
  const auto normals = vertex_normals(mesh);
  for (std::size_t i = 0; i < normals.size(); ++i)
    EXPECT_GT(normals[i].cast<double>().dot((mesh.vertices[i] - Eigen::Vector3d(5, 5, 5)) / 2), 0.99);
  EXPECT_NEAR(signed_volume(mesh), 4.0 / 3.0 * std::numbers::pi * 8, 0.4);
}

TEST(MeshTopology, GenusComponentsAndBorders) {
  const MeshTopology ball = mesh_topology(test::sphere(1));
  EXPECT_TRUE(ball.closed_manifold());
  EXPECT_EQ(ball.euler_characteristic, 2);
  EXPECT_EQ(mesh_topology(test::torus(2, 0.5)).euler_characteristic, 0);

  TriangleMesh open = test::box({0, 0, 0}, {1, 1, 1});
  std::vector<std::uint8_t> keep(open.faces.size(), 1);
  keep[0] = keep[1] = 0;  // the side z = 0
  open = with_faces(open, keep);
  const MeshTopology topology = mesh_topology(open);
  EXPECT_EQ(topology.boundary_edges, 4U);
  EXPECT_EQ(topology.boundary_loops, 1U);
  const auto loops = boundary_loops(open);
  ASSERT_EQ(loops.size(), 1U);
  ASSERT_EQ(loops[0].vertices.size(), 4U);
  // The loop runs against its faces, so a fan over it closes the box with the orientation of the rest.
  TriangleMesh closed = open;
  const auto& loop = loops[0].vertices;
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) closed.faces.push_back({loop[0], loop[i], loop[i + 1]});
  EXPECT_TRUE(mesh_topology(closed).closed_manifold());
  EXPECT_NEAR(signed_volume(closed), 1.0, 1e-12);
}

TEST(MeshTopology, APinchedBorderIsSplitIntoSimpleLoops) {
  // Three triangles in a ring, each touching the next in a vertex: one border, and the loops of a walk along
  // it depend on where it starts unless they are split wherever a vertex comes up again.
  TriangleMesh ring;
  ring.vertices = {{0, 0, 0}, {2, 0, 0}, {1, 2, 0}, {1, -1, 0}, {2.5, 1.5, 0}, {-0.5, 1.5, 0}};
  ring.faces = {{0, 3, 1}, {1, 4, 2}, {2, 5, 0}};
  for (int turn = 0; turn < 3; ++turn) {
    std::rotate(ring.faces.begin(), ring.faces.begin() + 1, ring.faces.end());
    std::size_t steps = 0;
    for (const BoundaryLoop& loop : boundary_loops(ring)) {
      EXPECT_TRUE(loop.closed);
      steps += loop.vertices.size();
      const std::set<std::uint32_t> distinct(loop.vertices.begin(), loop.vertices.end());
      EXPECT_EQ(distinct.size(), loop.vertices.size());
    }
    EXPECT_EQ(steps, 9U);
    EXPECT_EQ(mesh_topology(ring).borders, 1U);
  }
  TriangleMesh bow_tie;
  bow_tie.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}};
  bow_tie.faces = {{0, 1, 2}, {0, 3, 4}};
  EXPECT_EQ(mesh_topology(bow_tie).boundary_loops, 2U);
  EXPECT_EQ(mesh_topology(bow_tie).borders, 1U);
  EXPECT_EQ(mesh_topology(bow_tie).components, 2U);
}

TEST(MeshTopology, ABorderAlongInconsistentFacesIsNoClosedLoop) {
  TriangleMesh open = test::box({0, 0, 0}, {1, 1, 1});
  open.faces.erase(open.faces.begin());
  for (Face& f : open.faces)
    if (std::count(f.begin(), f.end(), open.faces[0][0]) != 0) {
      std::swap(f[1], f[2]);
      break;
    }
  const auto loops = boundary_loops(open);
  EXPECT_TRUE(std::any_of(loops.begin(), loops.end(), [](const BoundaryLoop& l) { return !l.closed; }));
}

TEST(MeshTopology, CountsWrongEdges) {
  TriangleMesh fin = test::box({0, 0, 0}, {1, 1, 1});
  fin.vertices.emplace_back(0.5, -1, -1);
  fin.faces.push_back({0, 1, 8});
  EXPECT_EQ(mesh_topology(fin).non_manifold_edges, 1U);
  TriangleMesh flipped = test::box({0, 0, 0}, {1, 1, 1});
  std::swap(flipped.faces[0][1], flipped.faces[0][2]);
  EXPECT_EQ(mesh_topology(flipped).inconsistent_edges, 3U);
}

TEST(TriangleMesh, WithFacesKeepsAttributesWithTheirVertices) {
  TriangleMesh mesh = test::box({0, 0, 0}, {1, 1, 1});
  for (const auto& v : mesh.vertices) mesh.colors.push_back(v.cast<float>());
  mesh.filled.assign(mesh.faces.size(), 0);
  mesh.filled[3] = 1;
  std::vector<std::uint8_t> keep(mesh.faces.size(), 0);
  keep[3] = 1;
  const TriangleMesh one = with_faces(mesh, keep);
  ASSERT_EQ(one.vertices.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(one.colors[i].cast<double>(), one.vertices[i]);
  EXPECT_EQ(one.filled, std::vector<std::uint8_t>{1});
  EXPECT_EQ(problem_of(one), "");
}

TEST(TriangleMesh, ProblemsAreNamed) {
  TriangleMesh mesh = test::box({0, 0, 0}, {1, 1, 1});
  mesh.faces[2][1] = 99;
  EXPECT_EQ(problem_of(mesh), "face 2 names vertex 99, but there are only 8");
  mesh = test::box({0, 0, 0}, {1, 1, 1});
  mesh.vertices[4].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(problem_of(mesh).find("vertex 4"), std::string::npos);
}

TEST(TriangleMesh, MedianEdgeOfATorus) {
  EXPECT_EQ(median_edge_length(TriangleMesh{}), 0.0);
  const double median = median_edge_length(test::torus(2, 0.5, 96, 24));
  EXPECT_GT(median, 0.12);
  EXPECT_LT(median, 0.2);
}

TEST(BoundingBox, LeavesOutWhatIsNotFinite) {
  const std::vector<Eigen::Vector3d> points = {
      {1, 2, 3}, {std::numeric_limits<double>::infinity(), 0, 0}, {-1, 5, 0}};
  const BoundingBox box = bounding_box(points);
  EXPECT_EQ(box.min(), Eigen::Vector3d(-1, 2, 0));
  EXPECT_EQ(box.max(), Eigen::Vector3d(1, 5, 3));
}

}  // namespace
}  // namespace drape
