#include "drape/metrics/surface_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "drape/base/parallel.hpp"
#include "drape/base/random.hpp"
#include "drape/geometry/rigid3.hpp"
#include "drape/metrics/surface_tree.hpp"
#include "support.hpp"

namespace drape::metrics {
namespace {

TriangleMesh plane(double z, int steps) {
  TriangleMesh mesh;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= steps; ++j)
      mesh.vertices.emplace_back(static_cast<double>(i) / steps, static_cast<double>(j) / steps, z);
  const auto index = [&](int i, int j) { return static_cast<std::uint32_t>(i * (steps + 1) + j); };
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      mesh.faces.push_back({index(i, j), index(i + 1, j), index(i, j + 1)});
      mesh.faces.push_back({index(i, j + 1), index(i + 1, j), index(i + 1, j + 1)});
    }
  return mesh;
}

TriangleMesh moved(TriangleMesh mesh, const Rigid3& motion) {
  for (Eigen::Vector3d& v : mesh.vertices) v = motion * v;
  return mesh;
}

// Distance of a point to a segment and to a triangle, straight from the definition: the foot of the
// perpendicular where it lies inside, else the nearest side.
double to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double length = (b - a).squaredNorm();
  const double t = length > 0 ? std::clamp((p - a).dot(b - a) / length, 0.0, 1.0) : 0.0;
  return (p - a - t * (b - a)).norm();
}

double to_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                   const Eigen::Vector3d& c) {
  const Eigen::Vector3d normal = (b - a).cross(c - a).stableNormalized();
  const double sides[] = {normal.dot((b - a).cross(p - a)), normal.dot((c - b).cross(p - b)),
                          normal.dot((a - c).cross(p - c))};
  if (sides[0] >= 0 && sides[1] >= 0 && sides[2] >= 0) return std::abs(normal.dot(p - a));
  return std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
}

double by_brute_force(const Eigen::Vector3d& p, const TriangleMesh& mesh) {
  double least = std::numeric_limits<double>::infinity();
  for (const Face& f : mesh.faces)
    least = std::min(least, to_triangle(p, mesh.vertices[f[0]], mesh.vertices[f[1]], mesh.vertices[f[2]]));
  return least;
}

TEST(SurfaceDistance, OfAShiftedPlaneIsTheShift) {
  const TwoWayDistance d = two_way_distance(plane(0.25, 4), plane(0, 7));
  for (const Distribution& side : {d.extra, d.missing}) {
    EXPECT_NEAR(side.mean, 0.25, 1e-15);
    EXPECT_NEAR(side.rms, 0.25, 1e-15);
    EXPECT_NEAR(side.percentile_95, 0.25, 1e-15);
    EXPECT_NEAR(side.max, 0.25, 1e-15);
  }
  EXPECT_EQ(d.extra.count, 25U);
  EXPECT_EQ(d.missing.count, 64U);
}

TEST(SurfaceDistance, OfAScaledSphereIsTheDifferenceOfTheRadii) {
  // The chords of the inner sphere lie up to r (1 - cos(step / 2)) per direction inside it.
  const int rings = 48;
  const double sag = 2 * (1 - std::cos(std::numbers::pi / rings / 2)) * 2;
  const Distribution d = surface_distance(test::sphere(2.1, rings), test::sphere(2.0, rings));
  EXPECT_GE(d.mean, 0.1 - 1e-12);
  EXPECT_LE(d.max, 0.1 + sag);
  // A vertex of the inner sphere is nearest to a chord of the outer one, which is nearer than its vertices.
  const Distribution back = surface_distance(test::sphere(2.0, rings), test::sphere(2.1, rings));
  EXPECT_LE(back.max, 0.1 + 1e-12);
  EXPECT_GE(back.mean, 0.1 - sag);
}

TEST(SurfaceDistance, SamplesAreUniformOverTheArea) {
  // Half of a long strip lies on the plane, half rises to 1: mean distance a quarter.
  TriangleMesh ramp;
  ramp.vertices = {{0, 0, 0},
                   {1, 0, 0},
                   {1, 1, 0},
                   {0, 1, 0},
                   {1 + std::sqrt(0.5), 0, std::sqrt(0.5)},
                   {1 + std::sqrt(0.5), 1, std::sqrt(0.5)}};
  ramp.faces = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  TriangleMesh ground = test::box({-5, -5, -1}, {5, 5, 0});
  const Distribution d = surface_distance(ramp, ground, {.samples = 40'000, .seed = 2});
  EXPECT_EQ(d.count, 40'000U);
  EXPECT_NEAR(d.mean, std::sqrt(0.5) / 4, 0.002);
  EXPECT_NEAR(d.max, std::sqrt(0.5), 0.002);
  const Distribution again = surface_distance(ramp, ground, {.samples = 40'000, .seed = 2});
  EXPECT_EQ(d.mean, again.mean);
}

TEST(SurfaceDistance, MissingShowsAHoleThatExtraDoesNot) {
  const TriangleMesh whole = plane(0, 10);
  std::vector<std::uint8_t> keep(whole.faces.size(), 1);
  for (std::size_t i = 0; i < keep.size(); ++i) {
    const Face& f = whole.faces[i];
    const Eigen::Vector3d middle = (whole.vertices[f[0]] + whole.vertices[f[1]] + whole.vertices[f[2]]) / 3;
    if (middle.x() > 0.5) keep[i] = 0;
  }
  const TwoWayDistance d = two_way_distance(with_faces(whole, keep), whole);
  EXPECT_EQ(d.extra.max, 0);
  EXPECT_NEAR(d.missing.max, 0.5, 1e-12);
  EXPECT_NEAR(d.hausdorff(), 0.5, 1e-12);
}

TEST(SurfaceDistance, AgreesWithBruteForce) {
  const TriangleMesh mesh = test::torus(2, 0.5, 24, 12);
  Rng rng(11);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 500; ++i)
    points.emplace_back(rng.uniform(-4, 4), rng.uniform(-4, 4), rng.uniform(-2, 2));
  const std::vector<double> found = distances_to_surface(points, mesh);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_NEAR(found[i], by_brute_force(points[i], mesh), 1e-12);
}

TEST(SurfaceDistance, AgreesWithBruteForceOnSlivers) {
  Rng rng(12);
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < 300; ++i) {
    const Eigen::Vector3d at(rng.uniform(), rng.uniform(), rng.uniform());
    const Eigen::Vector3d along = Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
    const Eigen::Vector3d off = Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
    mesh.vertices.push_back(at);
    mesh.vertices.emplace_back(at + 0.3 * along);
    mesh.vertices.emplace_back(at + rng.uniform(0, 0.3) * along + std::pow(10, rng.uniform(-9, -1)) * off);
    mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 300; ++i) points.emplace_back(rng.uniform(), rng.uniform(), rng.uniform());
  for (std::size_t i = 0; i < 100; ++i) points.push_back(mesh.vertices[3 * i + 1]);
  const std::vector<double> found = distances_to_surface(points, mesh);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_NEAR(found[i], by_brute_force(points[i], mesh), 1e-9) << i;
}

TEST(SurfaceDistance, TheClosestPointLiesOnItsFace) {
  const TriangleMesh mesh = test::box({0, 0, 0}, {1, 1, 1});
  const SurfaceTree::Closest closest = SurfaceTree(mesh).closest({0.25, 0.5, 3});
  EXPECT_LT((closest.point - Eigen::Vector3d(0.25, 0.5, 1)).norm(), 1e-12);
  EXPECT_NEAR(closest.distance, 2, 1e-12);
  EXPECT_TRUE(closest.face == 2 || closest.face == 3);  // the two faces of z = 1
}

TEST(SurfaceDistance, RigidMotionOfBothChangesNothing) {
  const TriangleMesh a = test::sphere(1, 20);
  const TriangleMesh b = test::box({-0.8, -0.8, -0.8}, {0.8, 0.8, 0.8});
  Rigid3 motion = Rigid3::Identity();
  motion.rotate(Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -0.5).normalized()));
  motion.pretranslate(Eigen::Vector3d(1e5, -2e5, 3e4));
  const Distribution before = surface_distance(a, b);
  const Distribution after = surface_distance(moved(a, motion), moved(b, motion));
  // A double at 2e5 has steps of 3e-11.
  EXPECT_NEAR(before.mean, after.mean, 1e-10);
  EXPECT_NEAR(before.max, after.max, 1e-10);
}

TEST(SurfaceDistance, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh a = test::sphere(1, 40);
  const TriangleMesh b = test::torus(0.9, 0.4);
  set_thread_count(1);
  const auto one = distances_to_surface(a.vertices, b);
  set_thread_count(4);
  const auto four = distances_to_surface(a.vertices, b);
  set_thread_count(0);
  EXPECT_EQ(one, four);
}

TEST(SurfaceDistance, UnusedVerticesAreNotMeasured) {
  TriangleMesh mesh = plane(0, 2);
  mesh.vertices.emplace_back(0, 0, 100);
  EXPECT_EQ(surface_distance(mesh, plane(0, 2)).max, 0);
}

TEST(SurfaceDistance, FacesWithoutAreaAreLeftOut) {
  TriangleMesh mesh = plane(0, 2);
  mesh.vertices.emplace_back(0.5, 0.5, 1);
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  mesh.faces.push_back({0, last, last});
  const std::vector<Eigen::Vector3d> above = {{0.5, 0.5, 1}};
  EXPECT_NEAR(surface_distance(above, mesh).max, 1, 1e-15);
}

TEST(SurfaceDistance, NothingToMeasureIsAnError) {
  const TriangleMesh box = test::box({0, 0, 0}, {1, 1, 1});
  const std::vector<Eigen::Vector3d> points = {{0, 0, 0}};
  const auto message = [](auto call) { return test::error_message(ErrorCode::input, call); };
  EXPECT_NE(
      message([&] { (void)surface_distance(std::span<const Eigen::Vector3d>(), box); }).find("no points"),
      std::string::npos);
  EXPECT_NE(message([&] { (void)surface_distance(points, TriangleMesh{}); }).find("without faces"),
            std::string::npos);
  EXPECT_NE(message([&] { (void)surface_distance(TriangleMesh{}, box); }).find("without area"),
            std::string::npos);
  TriangleMesh flat;
  flat.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  flat.faces = {{0, 1, 2}};
  EXPECT_NE(message([&] { (void)surface_distance(points, flat); }).find("have no area"), std::string::npos);
  EXPECT_NE(message([&] { (void)surface_distance(flat, box); }).find("without area"), std::string::npos);
  TriangleMesh broken = box;
  broken.faces[1][2] = 77;
  EXPECT_NE(message([&] { (void)surface_distance(points, broken); }).find("vertex 77"), std::string::npos);
  EXPECT_NE(message([&] { (void)surface_distance(broken, box); }).find("vertex 77"), std::string::npos);
  const std::vector<Eigen::Vector3d> bad = {{0, 0, 0}, {0, std::nan(""), 0}};
  EXPECT_NE(message([&] { (void)surface_distance(bad, box); }).find("point 1"), std::string::npos);
}

}  // namespace
}  // namespace drape::metrics
