#include "drape/geometry/ray_caster.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "drape/base/random.hpp"
#include "support.hpp"

namespace drape {
namespace {

using Eigen::Vector3d;

Vector3d random_vector(Rng& random, double extent) {
  return {random.uniform(-extent, extent), random.uniform(-extent, extent), random.uniform(-extent, extent)};
}

/// Every face, by Cramer's rule.
std::optional<double> naive_first_hit(const TriangleMesh& mesh, const Vector3d& origin,
                                      const Vector3d& direction) {
  std::optional<double> best;
  for (const Face& face : mesh.faces) {
    Eigen::Matrix3d system;
    system << mesh.vertices[face[1]] - mesh.vertices[face[0]],
        mesh.vertices[face[2]] - mesh.vertices[face[0]], -direction;
    const Vector3d uvt = system.partialPivLu().solve(origin - mesh.vertices[face[0]]);
    if (!uvt.allFinite() || uvt.x() < 0 || uvt.y() < 0 || uvt.x() + uvt.y() > 1 || uvt.z() <= 0) continue;
    if (!best || uvt.z() < *best) best = uvt.z();
  }
  return best;
}

TEST(RayCaster, AgreesWithEveryFaceTried) {
  const TriangleMesh mesh = test::torus(1.0, 0.4, 24, 16);
  const RayCaster caster(mesh);
  Rng random(5);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d origin = random_vector(random, 2);
    const Vector3d direction = random_vector(random, 1);
    const auto expected = naive_first_hit(mesh, origin, direction);
    const auto hit = caster.first_hit(origin, direction);
    ASSERT_EQ(expected.has_value(), hit.has_value()) << "ray " << i;
    EXPECT_EQ(expected.has_value(), caster.blocked(origin, direction));
    if (!hit) continue;
    ++hits;
    EXPECT_NEAR(hit->distance, *expected, 1e-9);
    const Face& face = mesh.faces[hit->face];
    Vector3d point = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) point += hit->weights[k] * mesh.vertices[face[static_cast<std::size_t>(k)]];
    EXPECT_LT((point - origin - hit->distance * direction).norm(), 1e-9);
  }
  EXPECT_GT(hits, 300);
}

TEST(RayCaster, LetsNoRayThroughEdgesAndVertices) {
  const TriangleMesh mesh = test::sphere(1, 12);
  const RayCaster caster(mesh);
  const Vector3d inside(0.1, -0.2, 0.05);
  for (const Face& face : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d a = mesh.vertices[face[k]];
      const Vector3d b = mesh.vertices[face[(k + 1) % 3]];
      EXPECT_TRUE(caster.blocked(inside, a - inside));
      EXPECT_TRUE(caster.blocked(inside, (0.3 * a + 0.7 * b) - inside));
    }
}

TEST(RayCaster, RaysAlongTheAxesMeetAxisAlignedFaces) {
  const RayCaster caster(test::box({0, 0, 0}, {1, 2, 3}));
  const auto hit = caster.first_hit({0.25, 0.5, -1}, Vector3d::UnitZ());
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(hit->distance, 1);
  EXPECT_FALSE(caster.blocked({1.5, 0.5, -1}, Vector3d::UnitZ()));
  EXPECT_FALSE(caster.blocked({0.25, 0.5, -1}, -Vector3d::UnitZ()));
}

TEST(RayCaster, MaxDistanceEndsTheRay) {
  const RayCaster caster(test::box({-1, -1, 2}, {1, 1, 3}));
  EXPECT_FALSE(caster.blocked({0, 0, 0}, Vector3d::UnitZ(), 1.999));
  EXPECT_TRUE(caster.blocked({0, 0, 0}, Vector3d::UnitZ(), 2.001));
  EXPECT_FALSE(caster.first_hit({0, 0, 0}, Vector3d::UnitZ(), 1.999));
  EXPECT_NEAR(caster.first_hit({0, 0, 0}, 2 * Vector3d::UnitZ())->distance, 1, 1e-15);
}

TEST(RayCaster, NothingIsHitInAMeshWithoutFaces) {
  EXPECT_FALSE(RayCaster(TriangleMesh{}).blocked({0, 0, 0}, Vector3d::UnitX()));
}

TEST(RayCaster, FacesWithoutAreaAndManyEqualOnesDoNoHarm) {
  TriangleMesh mesh = test::box({0, 0, 0}, {1, 1, 1});
  for (int i = 0; i < 100; ++i) mesh.faces.push_back({0, 0, 1});
  for (int i = 0; i < 100; ++i) mesh.faces.push_back(mesh.faces[0]);
  const auto hit = RayCaster(mesh).first_hit({0.3, 0.2, -1}, Vector3d::UnitZ());
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->face, 0U);  // of equal distances the lowest
}

}  // namespace
}  // namespace drape
