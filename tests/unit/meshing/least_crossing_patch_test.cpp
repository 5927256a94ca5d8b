#include "least_crossing_patch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "drape/base/random.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "drape/meshing/hole_filling.hpp"
#include "drape/meshing/mesh_quality.hpp"
#include "face_crossing.hpp"
#include "shapes.hpp"
#include "support.hpp"

namespace drape::meshing {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

// The least number of crossings over all triangulations of the corners i .. k, by trying all.
std::size_t least_of_all(const TriangleMesh& mesh, const std::vector<std::uint32_t>& loop, std::size_t i,
                         std::size_t k) {
  if (k - i < 2) return 0;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (std::size_t tip = i + 1; tip < k; ++tip) {
    const Face f{loop[i], loop[tip], loop[k]};
    const auto here = static_cast<std::size_t>(std::count_if(
        mesh.faces.begin(), mesh.faces.end(), [&](const Face& g) { return faces_cross(mesh, f, g); }));
    least = std::min(least, here + least_of_all(mesh, loop, i, tip) + least_of_all(mesh, loop, tip, k));
  }
  return least;
}

TEST(LeastCrossingPatch, IsTheLeastOfAllTriangulations) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Rng random(seed);
    const auto point = [&] { return Vector3d(random.uniform(), random.uniform(), random.uniform()); };
    TriangleMesh mesh;
    std::vector<std::uint32_t> loop;
    for (std::uint32_t i = 0; i < 8; ++i) {
      loop.push_back(i);
      const double angle = 2 * pi * i / 8;
      mesh.vertices.push_back(Vector3d(std::cos(angle), std::sin(angle), 0.3 * point().x()));
    }
    for (std::uint32_t i = 0; i < 12; ++i) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      const Vector3d middle = 2 * point() - Vector3d(1, 1, 0.5);
      for (int k = 0; k < 3; ++k) mesh.vertices.push_back(middle + 0.5 * (point() - Vector3d::Constant(0.5)));
      mesh.faces.push_back({first, first + 1, first + 2});
    }
    const auto found = least_crossing_patch(mesh, loop, mesh.faces);
    ASSERT_TRUE(found);
    EXPECT_TRUE(closes_hole(found->patch, loop.size(), {}));
    std::vector<Face> faces = mesh.faces;
    std::size_t within = 0;
    for (const Face& f : found->patch.faces) {
      for (const Face& g : faces) within += faces_cross(mesh, f, g) ? 1 : 0;
      faces.push_back(f);
    }
    EXPECT_EQ(found->crossings, within);
    // Over a disc seen from above no two triangles of one triangulation cross.
    EXPECT_EQ(found->crossings, least_of_all(mesh, loop, 0, loop.size() - 1)) << "seed " << seed;
  }
}

TEST(LeastCrossingPatch, TakesNoChordThatIsAnEdgeAndNoLoopThatIsTooLong) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 5}};
  mesh.faces = {{0, 2, 4}};
  const auto found = least_crossing_patch(mesh, {0, 1, 2, 3}, mesh.faces);
  ASSERT_TRUE(found);
  for (const Face& f : found->patch.faces)
    EXPECT_FALSE(std::count(f.begin(), f.end(), 0U) == 1 && std::count(f.begin(), f.end(), 2U) == 1);
  mesh.faces.push_back({1, 3, 4});
  EXPECT_FALSE(least_crossing_patch(mesh, {0, 1, 2, 3}, mesh.faces));
  const TriangleMesh sphere = test::sphere(1, 40);
  std::vector<std::uint32_t> loop(most_edges_for_least_crossings + 1);
  for (std::uint32_t i = 0; i < loop.size(); ++i) loop[i] = i;
  EXPECT_FALSE(least_crossing_patch(sphere, loop, {}));
}

// A tube that ends in a wall: its mouth is half before it and half behind. Every patch cuts the wall: two
// triangles at least, since the mouth's border runs through it in two places.
TEST(LeastCrossingPatch, AMouthThatStraddlesAWallCutsItAsLittleAsCanBe) {
  TriangleMesh mesh;
  mesh.vertices = {{0, -5, -50}, {0, 100, -50}, {0, -5, 50}};
  mesh.faces = {{0, 1, 2}};
  constexpr std::uint32_t around = 24;
  constexpr std::uint32_t rings = 3;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t ring = 0; ring < rings; ++ring)
    for (std::uint32_t i = 0; i < around; ++i) {
      const double angle = 2 * pi * (i + 0.3) / around;  // no vertex in the wall itself
      const double y = 1.6 * std::cos(angle);
      mesh.vertices.emplace_back(0.3 * y - 1.2 * ring, y + 3.0 * ring, 1.6 * std::sin(angle));
    }
  for (std::uint32_t ring = 0; ring + 1 < rings; ++ring)
    for (std::uint32_t i = 0; i < around; ++i) {
      const std::uint32_t a = first + ring * around + i;
      const std::uint32_t b = first + ring * around + (i + 1) % around;
      mesh.faces.push_back({a, b, b + around});
      mesh.faces.push_back({a, b + around, a + around});
    }
  const std::size_t before = self_intersecting_pairs(mesh).size();
  FillOptions options;
  options.max_hole_size_spacings = 15;
  const FillResult result = fill_holes(mesh, 1, options);
  // The tube's two ends, and not the wall's rim.
  EXPECT_EQ(std::count_if(result.holes.begin(), result.holes.end(), [](const Hole& h) { return h.filled(); }),
            2);
  EXPECT_EQ(result.self_intersections, 2U);
  EXPECT_EQ(self_intersecting_pairs(result.mesh).size() - before, 2U);
}

}  // namespace
}  // namespace drape::meshing
