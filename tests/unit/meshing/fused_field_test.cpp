// What becomes of a fused field: smoothed, and cut into triangles cube by cube.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "cube_cases.hpp"
#include "depth_map.hpp"
#include "drape/base/random.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "drape/meshing/mesh_quality.hpp"
#include "field_cleaning.hpp"
#include "field_smoothing.hpp"
#include "marching_cubes.hpp"

namespace drape::meshing {
namespace {

using Eigen::Vector3d;

// A field of noise has every case beside every other. 3 x 3 x 3 blocks.
std::pair<FusionBlocks, FusedField> field_of_noise() {
  FusionBlocks blocks;
  blocks.lattice.voxel = 1;
  FusedField field;
  Rng random(3);
  for (int z = 1; z < 4; ++z)
    for (int y = 1; y < 4; ++y)
      for (int x = 1; x < 4; ++x) {
        blocks.keys.push_back(BlockKey(x, y, z).number());
        for (int i = 0; i < VoxelLattice::block_voxels; ++i)
          field.distances.push_back(
              static_cast<std::int16_t>(2 * (static_cast<int>(random.below(20001)) - 10000)));
      }
  return {std::move(blocks), std::move(field)};
}

TriangleMesh surface_at_once(const FusionBlocks& blocks, const FusedField& field) {
  MarchingCubes cubes(blocks);
  cubes.number(field, blocks.size());
  std::vector<SurfacePart> parts;
  parts.push_back(cubes.part(field, blocks.size()));
  return joined(std::move(parts), blocks);
}

TEST(MarchingCubes, SlabBySlabMakesTheSameMesh) {
  const auto [blocks, field] = field_of_noise();
  const TriangleMesh whole = surface_at_once(blocks, field);
  FusedField window = field;
  MarchingCubes cubes(blocks);
  std::vector<SurfacePart> parts;
  cubes.number(window, 9);
  for (std::size_t end = 9; end <= 27; end += 9) {
    cubes.number(window, std::min<std::size_t>(end + 9, 27));
    parts.push_back(cubes.part(window, end));
    window.forget_before(end);
  }
  const TriangleMesh slabs = joined(std::move(parts), blocks);
  EXPECT_EQ(slabs.vertices, whole.vertices);
  EXPECT_EQ(slabs.faces, whole.faces);
}

// 3 x 3 x 3 blocks from voxel (8, 8, 8) on, of distances in voxels.
template <class Distance>
std::pair<FusionBlocks, FusedField> field_of(Distance distance) {
  auto [blocks, field] = field_of_noise();
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (int i = 0; i < VoxelLattice::block_voxels; ++i) {
      const Eigen::Vector3i at = blocks.corner(b) + Eigen::Vector3i(i % 8, i / 8 % 8, i / 64);
      const double steps =
          std::clamp(distance(at.cast<double>().eval()) / FusedField::step_voxels, -32766.0, 32766.0);
      field.distances[b * VoxelLattice::block_voxels + static_cast<std::size_t>(i)] =
          static_cast<std::int16_t>(2 * std::lround(steps / 2));
    }
  return {std::move(blocks), std::move(field)};
}

FusedField smoothed_field(const FusionBlocks& blocks, const FusedField& field,
                          const std::vector<float>& steps) {
  FusedField smooth;
  smooth_blocks(smooth, field, blocks, steps, blocks.size());
  return smooth;
}

TEST(FieldSmoothing, TakesNoiseOffAPlaneAcrossBlocks) {
  Rng random(1);
  const auto plane = [](const Vector3d& p) { return p.z() - 0.3 * p.x() - 14.8; };
  const auto [blocks, field] = field_of([&](const Vector3d& p) { return plane(p) + 0.2 * random.normal(); });
  const auto error = [&, &b = blocks](const FusedField& f) {
    double sum = 0;
    const TriangleMesh mesh = surface_at_once(b, f);
    for (const Vector3d& p : mesh.vertices) sum += std::pow(plane(p), 2);
    return std::sqrt(sum / static_cast<double>(mesh.vertices.size()));
  };
  const double before = error(field);
  EXPECT_LT(error(smoothed_field(blocks, field, {1})), 0.5 * before);
  EXPECT_LT(error(smoothed_field(blocks, field, {1, 1})), 0.35 * before);
}

TEST(FieldSmoothing, LeavesPlanesGuessesAndTheUnknownAndKeepsCreases) {
  auto [blocks, field] = field_of([](const Vector3d& p) { return std::max(p.z(), p.x()) - 19.5; });
  field.distances[13 * 512 + 300] = FusedField::unknown;
  field.distances[13 * 512 + 301] = 4001;  // a guess
  const FusedField smooth = smoothed_field(blocks, field, {1, 1});
  for (std::size_t i = 0; i < field.distances.size(); ++i) {
    const std::size_t voxel = i % VoxelLattice::block_voxels;
    const Eigen::Vector3i at = blocks.corner(i / VoxelLattice::block_voxels) +
                               Eigen::Vector3i(static_cast<int>(voxel % 8), static_cast<int>(voxel / 8 % 8),
                                               static_cast<int>(voxel / 64));
    const double moved = std::abs(smooth.distances[i] - field.distances[i]) * FusedField::step_voxels;
    // A mean over 5 x 5 x 5 voxels rounds the crease by 0.8.
    EXPECT_LE(moved, std::abs(at.x() - at.z()) > 4 ? 1e-3 : 0.5) << at.transpose();
    if (FusedField::is_guess(field.distances[i]) || field.distances[i] == FusedField::unknown) {
      EXPECT_EQ(smooth.distances[i], field.distances[i]);
    }
  }
}

TEST(FieldSmoothing, IsForNoise) {
  const auto sum = [](std::span<const float> steps) {
    return std::accumulate(steps.begin(), steps.end(), 0.0F);
  };
  EXPECT_TRUE(smoothing_steps(0.1).empty());
  EXPECT_NEAR(sum(smoothing_steps(0.6)), 0.1, 1e-6);
  EXPECT_EQ(sum(smoothing_steps(1.2)), 2);
}

TEST(FieldSmoothing, ThereAndBackTakesNoiseAndLeavesARoundShape) {
  Rng random(2);
  const auto ball = [](const Vector3d& p) { return (p - Vector3d::Constant(19.5)).norm() - 6; };
  const auto [blocks, exact] = field_of(ball);
  const auto [same_blocks, noisy] =
      field_of([&](const Vector3d& p) { return ball(p) + 0.2 * random.normal(); });
  const auto shift_and_spread = [&, &b = blocks](const FusedField& f) {
    const TriangleMesh mesh = surface_at_once(b, f);
    const auto count = static_cast<double>(mesh.vertices.size());
    double sum = 0;
    double squares = 0;
    for (const Vector3d& p : mesh.vertices) {
      sum += ball(p);
      squares += ball(p) * ball(p);
    }
    return std::pair(sum / count, std::sqrt(squares / count));
  };
  const std::span<const float> steps = smoothing_steps(0.6);
  const std::vector<float> there_and_back(steps.begin(), steps.end());
  const double shrunk = shift_and_spread(smoothed_field(blocks, exact, {1})).first;
  EXPECT_LT(shrunk, -0.05);
  EXPECT_GT(shift_and_spread(smoothed_field(blocks, exact, there_and_back)).first, 0.3 * shrunk);
  EXPECT_LT(shift_and_spread(smoothed_field(blocks, noisy, there_and_back)).second,
            0.75 * shift_and_spread(noisy).second);
}

TEST(DepthMaps, FollowABendBetweenSamples) {
  // A paraboloid's samples at every third pixel: chords lie up to .04 off it.
  const auto depth = [](float x, float y) { return 50 + 0.02F * x * x + 0.01F * y * y; };
  RangeSheet sheet;
  constexpr std::uint32_t side = 8;
  for (std::uint32_t y = 0; y < side; ++y)
    for (std::uint32_t x = 0; x < side; ++x) {
      const float column = 3 + 3 * static_cast<float>(x);
      const float row = 3 + 3 * static_cast<float>(y);
      sheet.samples.push_back({column, row, depth(column, row), 0.04F * column, 0.02F * row, 1});
      const std::uint32_t a = y * side + x;
      if (x + 1 == side || y + 1 == side) continue;
      sheet.faces.push_back({a, a + 1, a + side + 1});
      sheet.faces.push_back({a, a + side + 1, a + side});
    }
  const DepthMap map = depth_map(sheet, false, 6);
  for (float row = 4.3F; row < 23; row += 0.7F)
    for (float column = 4.1F; column < 23; column += 0.9F)
      EXPECT_NEAR(map.at(column, row)[0], depth(column, row), 1e-3) << column << ", " << row;
}

TEST(FieldCleaning, WallsThatMeetAtTheBorderAreParted) {
  // Two walls a tenth of a voxel apart that meet along a sharp bend, open at both ends of it.
  TriangleMesh mesh;
  constexpr std::uint32_t columns = 6;
  for (std::uint32_t x = 0; x < columns; ++x)
    for (const double y : {-2.0, -1.0, 0.0, 1.0, 2.0})
      mesh.vertices.emplace_back(x, std::abs(y), y < 0 ? -0.05 * y : 0);
  const auto add = [&](std::uint32_t x, std::uint32_t y) {
    const std::uint32_t a = 5 * x + y;
    mesh.faces.push_back({a, a + 5, a + 6});
    mesh.faces.push_back({a, a + 6, a + 1});
  };
  for (std::uint32_t x = 0; x + 1 < columns; ++x)
    for (std::uint32_t y = 0; y < 4; ++y) add(x, y);
  const Cleaned cleaned = without_folded_border(mesh);
  EXPECT_EQ(cleaned.removed, 2U);
  EXPECT_EQ(cleaned.mesh.faces.size(), mesh.faces.size() - 6);

  TriangleMesh flat = mesh;
  for (std::size_t v = 0; v < flat.vertices.size(); ++v)
    flat.vertices[v] = {static_cast<double>(v / 5), static_cast<double>(v % 5), 0};
  EXPECT_EQ(without_folded_border(flat).removed, 0U);
}

TEST(CubeCases, AreClosedBetweenCubesWhateverTheField) {
  const auto [blocks, field] = field_of_noise();
  const TriangleMesh mesh = surface_at_once(blocks, field);
  ASSERT_GT(mesh.faces.size(), 20000U);
  const MeshQuality quality = mesh_quality(mesh);
  EXPECT_EQ(quality.non_manifold_edges, 0U);
  EXPECT_EQ(quality.inconsistent_edges, 0U);
  EXPECT_EQ(quality.non_manifold_vertices, 0U);
  EXPECT_EQ(quality.degenerate_faces, 0U);
  // The border is on the outside of the 3 x 3 x 3 blocks only.
  for (const auto& loop : boundary_loops(mesh))
    for (const std::uint32_t v : loop.vertices) {
      const Vector3d& p = mesh.vertices[v];
      EXPECT_TRUE((p.array() == 8).any() || (p.array() == 31).any()) << p.transpose();
    }
}

TEST(CubeCases, DoNotCrossThemselvesWhereverTheEdgesAreCut) {
  Rng random(1);
  for (std::size_t inside = 0; inside < 256; ++inside) {
    const CubeCase& cube = cube_cases()[inside];
    for (int trial = 0; trial < 200; ++trial) {
      TriangleMesh mesh;
      for (int edge = 0; edge < 12; ++edge) {
        const int corner = edge_corner(edge);
        mesh.vertices.emplace_back(corner & 1, (corner >> 1) & 1, corner >> 2);
        mesh.vertices.back()[edge / 4] += random.uniform(0.02, 0.98);
      }
      for (std::size_t t = 0; t < static_cast<std::size_t>(cube.triangles); ++t)
        mesh.faces.push_back({cube.edges[t][0], cube.edges[t][1], cube.edges[t][2]});
      EXPECT_TRUE(self_intersecting_pairs(mesh).empty()) << "case " << inside;
    }
  }
}

TEST(CubeCases, OneCornerInsideIsCutOffOutward) {
  const CubeCase& cube = cube_cases()[1];
  ASSERT_EQ(cube.triangles, 1);
  std::array<Vector3d, 3> p;
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_EQ(edge_corner(cube.edges[0][k]), 0);
    p[k] = Vector3d::Unit(cube.edges[0][k] / 4);
  }
  EXPECT_GT((p[1] - p[0]).cross(p[2] - p[0]).sum(), 0);
}

}  // namespace
}  // namespace drape::meshing
