#include "drape/meshing/simplify.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "drape/meshing/mesh_quality.hpp"
#include "shapes.hpp"
#include "support.hpp"

namespace drape::meshing {
namespace {

TEST(Simplify, KeepsShapeTopologyAndItsOwnVertices) {
  TriangleMesh torus = test::torus(10, 4, 200, 80);
  for (Eigen::Vector3d& p : torus.vertices)
    p += Eigen::Vector3d(1e5, 0, 0);  // far off: floats alone lose 8 mm
  for (const Eigen::Vector3d& p : torus.vertices)
    torus.colors.push_back(Eigen::Vector3f(static_cast<float>(p.z()), 0, 0));
  torus.normals = vertex_normals(torus);
  torus.filled.assign(torus.faces.size(), 0);
  for (std::size_t i = 0; i < torus.faces.size(); ++i)
    torus.filled[i] = torus.vertices[torus.faces[i][0]].x() > 1e5 ? 1 : 0;

  const TriangleMesh fewer = simplified(torus, {3200, 0});
  ASSERT_EQ(problem_of(fewer), "");
  EXPECT_LE(fewer.faces.size(), 3200U);
  EXPECT_GT(fewer.faces.size(), 3000U);
  const MeshQuality quality = mesh_quality(fewer);
  EXPECT_TRUE(quality.closed());
  EXPECT_EQ(quality.genus, 1);
  EXPECT_NEAR(*quality.volume, signed_volume(torus), 0.01 * signed_volume(torus));

  std::set<std::array<double, 3>> own;
  for (const Eigen::Vector3d& p : torus.vertices) own.insert({p.x(), p.y(), p.z()});
  for (std::size_t v = 0; v < fewer.vertices.size(); ++v) {
    const Eigen::Vector3d& p = fewer.vertices[v];
    EXPECT_EQ(own.count({p.x(), p.y(), p.z()}), 1U);
    EXPECT_EQ(fewer.colors[v].x(), static_cast<float>(p.z()));
  }
  for (std::size_t i = 0; i < fewer.faces.size(); ++i) {
    const Face& f = fewer.faces[i];
    const double x =
        (fewer.vertices[f[0]].x() + fewer.vertices[f[1]].x() + fewer.vertices[f[2]].x()) / 3 - 1e5;
    if (std::abs(x) > 1) {
      EXPECT_EQ(fewer.filled[i], x > 0 ? 1 : 0);
    }
  }
}

TEST(Simplify, LeavesSmallMeshesAlone) {
  const TriangleMesh mesh = test::sphere(1, 10);
  EXPECT_EQ(simplified(mesh, {mesh.faces.size(), 0}).faces, mesh.faces);
  EXPECT_TRUE(simplified({}, {10, 0}).empty());
}

TEST(Simplify, StaysASurfaceWhenAskedForTooLittle) {
  const MeshQuality quality = mesh_quality(simplified(test::torus(10, 4, 60, 30), {1, 0}));
  EXPECT_TRUE(quality.manifold());
}

TEST(Simplify, TheErrorBoundHolds) {
  const TriangleMesh torus = test::torus(10, 4, 200, 80);
  const auto off = [](const Eigen::Vector3d& p) {
    return std::hypot(std::hypot(p.x(), p.y()) - 10, p.z()) - 4;
  };
  EXPECT_EQ(simplified(torus, {0, 0}).faces, torus.faces);
  std::size_t last = torus.faces.size();
  for (const double error : {0.02, 0.1, 0.5}) {
    const TriangleMesh fewer = simplified(torus, {0, error});
    EXPECT_LT(fewer.faces.size(), last / 2);
    last = fewer.faces.size();
    // The torus itself is 0.01 off between its vertices.
    EXPECT_LT(test::worst_distance(fewer, off), error + 0.01) << error;
    EXPECT_EQ(mesh_quality(fewer).genus, 1);
  }
  // The budget stops it first.
  EXPECT_GT(simplified(torus, {6000, 0.5}).faces.size(), 5900U);
}

TEST(Simplify, BordersStayBorders) {
  const TriangleMesh open =
      test::with_hole(test::sphere(10, 60), [](const Eigen::Vector3d& p) { return p.z() > 5; });
  const MeshQuality quality = mesh_quality(simplified(open, {1000, 0}));
  EXPECT_TRUE(quality.manifold());
  EXPECT_EQ(quality.boundary_loops, 1U);
  EXPECT_EQ(quality.components, 1U);
}

}  // namespace
}  // namespace drape::meshing
