#include "drape/rendering/depth_raster.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "drape/base/parallel.hpp"
#include "drape/base/random.hpp"
#include "drape/geometry/ray_caster.hpp"
#include "lattice_sheet.hpp"
#include "support.hpp"
#include "test_cameras.hpp"

namespace drape::rendering {
namespace {

using Projection = Camera::Projection;
constexpr Projection both_projections[] = {Projection::perspective, Projection::orthographic};

// Large and small triangles through each other.
TriangleMesh confetti(int count, std::uint64_t seed) {
  Rng rng(seed);
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d middle(rng.uniform(-0.7, 0.7), rng.uniform(-0.7, 0.7), rng.uniform(-0.7, 0.7));
    const double size = std::exp(rng.uniform(-5, 0));
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int k = 0; k < 3; ++k)
      mesh.vertices.emplace_back(middle + size * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()));
    mesh.faces.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

// What one ray a pixel hits first.
DepthMap cast(const TriangleMesh& mesh, const Camera& camera) {
  const RayCaster caster(mesh);
  DepthMap map{ImageF(camera.width, camera.height, 1, std::numeric_limits<float>::infinity()),
               Image<std::int32_t>(camera.width, camera.height, 1, DepthMap::no_face)};
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      constexpr double from = 0.01;
      const Eigen::Vector3d start = camera.unproject({x + 0.5, y + 0.5}, from);
      const auto hit = caster.first_hit(start, camera.unproject({x + 0.5, y + 0.5}, 1 + from) - start);
      if (!hit) continue;
      map.depth.at(x, y) = static_cast<float>(hit->distance + from);
      map.faces.at(x, y) = static_cast<std::int32_t>(hit->face);
    }
  return map;
}

TEST(RasteredDepth, IsWhatRaysHitFirst) {
  for (const Projection projection : both_projections)
    for (const std::uint64_t seed : {1, 2, 3}) {
      const TriangleMesh mesh = confetti(300, seed);
      const Camera camera = random_camera(seed, projection, 5, 150, 110);
      const DepthMap drawn = rastered_depth(mesh, camera);
      const DepthMap truth = cast(mesh, camera);
      int other = 0;
      for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
          if (drawn.faces.at(x, y) != truth.faces.at(x, y)) {
            ++other;
          } else if (drawn.faces.at(x, y) != DepthMap::no_face) {
            EXPECT_NEAR(drawn.depth.at(x, y), truth.depth.at(x, y), 1e-5);
          }
        }
      // An edge may run through a pixel's centre to rounding.
      EXPECT_LE(other, 2);
    }
}

TEST(RasteredDepth, SeesWhatTheRendererSees) {
  const TriangleMesh mesh = test::torus(0.7, 0.3, 64, 32);
  for (const Projection projection : both_projections) {
    const Camera camera = random_camera(4, projection);
    const DepthMap drawn = rastered_depth(mesh, camera);
    const DepthMap opengl = Renderer(mesh).depth_map(camera);
    int other = 0;
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x)
        if ((drawn.faces.at(x, y) == DepthMap::no_face) != (opengl.faces.at(x, y) == DepthMap::no_face))
          ++other;
    EXPECT_LE(other, 6);  // OpenGL snaps corners to fractions of a pixel
  }
}

// Every centre lies on an edge or a corner of the mesh.
TEST(RasteredDepth, LeavesNoCentreOnAnEdgeOut) {
  constexpr int side = 12;
  const TriangleMesh sheet = test::lattice_sheet(
      side, side, [](int x, int y) { return Eigen::Vector3d(x + 0.5, y + 0.5, 1 + 0.1 * x); });
  Camera camera;
  camera.projection = Projection::orthographic;
  camera.width = side + 1;
  camera.height = side + 1;
  for (const double shift : {0.0, 1.0 / 3}) {
    camera.K(0, 1) = shift;  // shear: edges that no numbers hold exactly
    camera.K(0, 2) = -shift * 0.5;
    const DepthMap map = rastered_depth(sheet, camera);
    for (int y = 0; y <= side; ++y)
      for (int x = shift == 0 ? 0 : static_cast<int>(std::floor(shift * y)) + 1; x <= side; ++x)
        EXPECT_NE(map.faces.at(x, y), DepthMap::no_face) << x << ", " << y;
  }
}

TEST(RasteredDepth, CutsAFaceThatReachesBehindTheCamera) {
  TriangleMesh floor;
  floor.vertices = {{-100, 0, -50}, {100, 0, -50}, {100, 0, 50}, {-100, 0, 50}};
  floor.faces = {{0, 1, 2}, {0, 2, 3}};
  const Camera camera = look_at({0, 1, 0}, {0, 1, 1}, {0, 1, 0}, 41, 41, 60);
  const DepthMap map = rastered_depth(floor, camera);
  const double focal = camera.K(0, 0);
  for (int y = 0; y < 41; ++y) {
    const double below = y + 0.5 - 20.5;
    const double depth = focal / below;
    if (std::abs(below) < 1e-9 || std::abs(depth - 50) < 1) continue;
    if (below > 0 && depth < 50)
      EXPECT_NEAR(map.depth.at(20, y), depth, 1e-6 * depth);
    else
      EXPECT_EQ(map.faces.at(20, y), DepthMap::no_face);
  }
}

TEST(RasteredDepth, OfNothingIsEmpty) {
  const Camera camera = random_camera(1, Projection::perspective, 5, 20, 10);
  EXPECT_EQ(rastered_depth({}, camera).faces, Image<std::int32_t>(20, 10, 1, DepthMap::no_face));
  const Camera away = look_at({0, 0, 5}, {0, 0, 10}, {0, 1, 0}, 40, 30, 60);
  EXPECT_EQ(rastered_depth(test::sphere(1), away).faces, Image<std::int32_t>(40, 30, 1, DepthMap::no_face));
  TriangleMesh broken;
  broken.vertices = {{0, 0, 0}};
  broken.faces = {{0, 1, 2}};
  EXPECT_FALSE(test::error_message(ErrorCode::input, [&] { (void)rastered_depth(broken, camera); }).empty());
}

TEST(RasteredDepth, DoesNotDependOnThreads) {
  const TriangleMesh mesh = confetti(500, 9);
  const Camera camera = random_camera(6, Projection::perspective);
  set_thread_count(1);
  const DepthMap alone = rastered_depth(mesh, camera);
  set_thread_count(3);
  const DepthMap together = rastered_depth(mesh, camera);
  set_thread_count(0);
  EXPECT_EQ(alone.faces, together.faces);
  EXPECT_EQ(alone.depth, together.depth);
}

}  // namespace
}  // namespace drape::rendering
