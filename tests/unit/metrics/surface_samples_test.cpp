#include "drape/metrics/surface_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support.hpp"

namespace drape::metrics {
namespace {

TEST(SurfaceSamples, EachFaceGetsItsShareOfTheArea) {
  const TriangleMesh mesh = test::box({0, 0, 0}, {1, 2, 7});
  constexpr std::size_t count = 20'000;
  std::vector<std::size_t> per_face(mesh.faces.size(), 0);
  for (const SurfaceSample& sample : surface_samples(mesh, count, 3)) ++per_face[sample.face];
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const double share = scaled_face_normal(mesh, i).norm() / 2 / surface_area(mesh);
    // Stratified: a face's count is off by less than the two samples at its ends.
    EXPECT_NEAR(static_cast<double>(per_face[i]), share * count, 2.0);
  }
}

TEST(SurfaceSamples, LieInTheirFaceAndFillItEvenly) {
  TriangleMesh mesh;
  mesh.vertices = {{10, 0, 1}, {13, 0, 1}, {10, 3, 1}};
  mesh.faces = {{0, 1, 2}};
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  constexpr std::size_t count = 10'000;
  for (const SurfaceSample& sample : surface_samples(mesh, count, 5)) {
    const Eigen::Vector3d& p = sample.point;
    EXPECT_GE(p.x(), 10 - 1e-12);
    EXPECT_GE(p.y(), -1e-12);
    EXPECT_LE(p.x() - 10 + p.y(), 3 + 1e-12);
    EXPECT_NEAR(p.z(), 1, 1e-12);
    sum += p;
  }
  // The centroid, within four standard errors (a coordinate's deviation is 3 / sqrt(18)).
  const double error = 4 * 3 / std::sqrt(18.0) / std::sqrt(static_cast<double>(count));
  EXPECT_LT((sum / count - Eigen::Vector3d(11, 1, 1)).norm(), 2 * error);
}

TEST(SurfaceSamples, SameSeedSamePointsOtherSeedOthers) {
  const TriangleMesh mesh = test::torus(2, 0.5);
  const auto once = surface_samples(mesh, 100, 7);
  const auto again = surface_samples(mesh, 100, 7);
  const auto others = surface_samples(mesh, 100, 8);
  std::size_t equal = 0;
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].point, again[i].point);
    equal += once[i].point == others[i].point ? 1 : 0;
  }
  EXPECT_EQ(equal, 0U);
}

TEST(SurfaceSamples, NeverOnAFaceWithoutArea) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}};
  mesh.faces = {{0, 1, 2}, {0, 1, 3}, {0, 0, 3}};
  for (const SurfaceSample& sample : surface_samples(mesh, 50, 1)) EXPECT_EQ(sample.face, 1U);
  mesh.faces = {{0, 1, 2}};
  EXPECT_TRUE(surface_samples(mesh, 50, 1).empty());
  EXPECT_TRUE(surface_samples(TriangleMesh{}, 50, 1).empty());
}

}  // namespace
}  // namespace drape::metrics
