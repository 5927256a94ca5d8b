#include <gtest/gtest.h>

#include <cmath>

#include "drape/base/random.hpp"
#include "drape/meshing/hole_filling.hpp"
#include "shapes.hpp"
#include "support.hpp"

namespace drape::meshing {
namespace {

constexpr std::uint32_t side = 41;

// A sheet folded at x = 0 by a right angle: y-z plane on one side, x-y plane on the other.
TriangleMesh folded_sheet(double noise) {
  TriangleMesh sheet;
  Rng rng(3);
  for (std::uint32_t j = 0; j < side; ++j)
    for (std::uint32_t i = 0; i < side; ++i) {
      const double u = static_cast<double>(i) - (side - 1) / 2.0;
      const double off = noise * rng.normal();
      sheet.vertices.push_back(u < 0 ? Eigen::Vector3d(off, j, -u) : Eigen::Vector3d(u, j, off));
      if (i + 1 == side || j + 1 == side) continue;
      const std::uint32_t v = j * side + i;
      sheet.faces.push_back({v, v + 1, v + side});
      sheet.faces.push_back({v + 1, v + side + 1, v + side});
    }
  return sheet;
}

double distance_to_fold(const Eigen::Vector3d& p) {
  return std::min(std::hypot(p.x(), std::min(p.z(), 0.0)), std::hypot(p.z(), std::min(p.x(), 0.0)));
}

double rms_error(const TriangleMesh& mesh, bool at_crease) {
  double sum = 0;
  double count = 0;
  for (std::uint32_t j = 2; j + 2 < side; ++j)
    for (std::uint32_t i = 2; i + 2 < side; ++i) {
      const bool near = i + 1 >= side / 2 && i <= side / 2 + 1;
      if (near != at_crease) continue;
      sum += std::pow(distance_to_fold(mesh.vertices[j * side + i]), 2);
      ++count;
    }
  return std::sqrt(sum / count);
}

TriangleMesh smoothed_sheet(const TriangleMesh& sheet, int rounds) {
  FillOptions options;
  options.smooth_rounds = rounds;
  return fill_holes(sheet, 1, options).mesh;
}

TEST(Smoothing, TakesNoiseAwayAndKeepsTheCrease) {
  constexpr double noise = 0.05;
  const TriangleMesh noisy = folded_sheet(noise);
  const TriangleMesh smooth = smoothed_sheet(noisy, 10);
  EXPECT_LT(rms_error(smooth, false), 0.5 * noise);
  // Averaging neighbours instead would round the crease off by a quarter of a spacing and more.
  EXPECT_LT(rms_error(smooth, true), noise);
}

TEST(Smoothing, ACleanFoldStaysAndBordersDoNotMove) {
  const TriangleMesh fold = folded_sheet(0);
  const TriangleMesh smooth = smoothed_sheet(fold, 5);
  EXPECT_LT(rms_error(smooth, true), 0.01);
  const TriangleMesh noisy = folded_sheet(0.05);
  const TriangleMesh result = smoothed_sheet(noisy, 5);
  for (std::uint32_t i = 0; i < side; ++i) EXPECT_EQ(result.vertices[i], noisy.vertices[i]);
  EXPECT_NE(result.vertices[5 * side + 5], noisy.vertices[5 * side + 5]);
}

TEST(Smoothing, OffByDefault) {
  const TriangleMesh noisy = folded_sheet(0.05);
  const TriangleMesh same = fill_holes(noisy, 1, {}).mesh;
  for (std::size_t v = 0; v < noisy.vertices.size(); ++v) ASSERT_EQ(same.vertices[v], noisy.vertices[v]);
}

}  // namespace
}  // namespace drape::meshing
