#include "drape/simulation/range_scanner.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "drape/base/parallel.hpp"
#include "support.hpp"

namespace drape::simulation {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double radius = 0.1;
constexpr double distance = 0.5;

/// In front of a scanner at the origin of the world.
TriangleMesh sphere_ahead() {
  return test::sphere(radius, 160, {0, 0, distance});
}
// How far the sphere's faces are inside the sphere, at most.
const double sagitta = radius * (1 - std::cos(pi / 160));

ScannerSpec spec_of(Rays rays) {
  ScannerSpec spec;
  spec.rays = rays;
  spec.rows = 90;
  spec.columns = 110;
  spec.pitch_deg = 0.3;
  spec.pitch_m = 0.0025;
  return spec;
}

double incidence_deg(const RangeScan& scan, const Vector3d& point) {
  const Vector3d normal = (point - Vector3d(0, 0, distance)).normalized();
  return std::acos(normal.dot(scan.view.towards_scanner(point))) * 180 / pi;
}

class BothKindsOfRays : public testing::TestWithParam<Rays> {};
INSTANTIATE_TEST_SUITE_P(RangeScanner, BothKindsOfRays, testing::Values(Rays::diverging, Rays::parallel),
                         [](const auto& test) {
                           return test.param == Rays::diverging ? "diverging" : "parallel";
                         });

TEST_P(BothKindsOfRays, PointsLieOnTheNearSideOfTheSphere) {
  const RangeScan taken = scan(sphere_ahead(), Rigid3::Identity(), spec_of(GetParam()));
  ASSERT_GT(taken.cloud.size(), 3000U);
  for (const Vector3d& point : taken.cloud.positions) {
    EXPECT_NEAR((point - Vector3d(0, 0, distance)).norm(), radius, sagitta + 1e-12);
    EXPECT_LT(point.z(), distance);
  }
}

TEST_P(BothKindsOfRays, NoiseIsAsLargeAsAskedAndGrowsWithIncidence) {
  ScannerSpec spec = spec_of(GetParam());
  spec.noise_m = 0.0002;
  const RangeScan noisy = scan(sphere_ahead(), Rigid3::Identity(), spec);
  spec.noise_m = 0;
  const RangeScan exact = scan(sphere_ahead(), Rigid3::Identity(), spec);
  ASSERT_EQ(noisy.grid->cells, exact.grid->cells);
  double steep = 0;
  double flat = 0;
  int steep_count = 0;
  int flat_count = 0;
  for (std::size_t i = 0; i < exact.cloud.size(); ++i) {
    const Vector3d error = noisy.cloud.positions[i] - exact.cloud.positions[i];
    const Vector3d along = exact.view.towards_scanner(exact.cloud.positions[i]);
    EXPECT_LT(error.cross(along).norm(), 1e-12);  // along the ray alone
    const double incidence = incidence_deg(exact, exact.cloud.positions[i]);
    if (incidence < 20) {
      flat += error.squaredNorm();
      ++flat_count;
    } else if (incidence > 58 && incidence < 62) {
      steep += error.squaredNorm();
      ++steep_count;
    }
  }
  // Standard deviations of n samples are known to 1 / sqrt(2n); allowed: 4 of those, and the cosines' spread.
  ASSERT_GT(steep_count, 200);
  EXPECT_NEAR(std::sqrt(flat / flat_count), 0.0002, 0.0002 * (4 / std::sqrt(2.0 * flat_count) + 0.07));
  EXPECT_NEAR(std::sqrt(steep / steep_count), 0.0004, 0.0004 * (4 / std::sqrt(2.0 * steep_count) + 0.07));
}

TEST_P(BothKindsOfRays, NothingReturnsBeyondTheIncidenceLimit) {
  ScannerSpec spec = spec_of(GetParam());
  spec.max_incidence_deg = 50;
  const RangeScan limited = scan(sphere_ahead(), Rigid3::Identity(), spec);
  spec.max_incidence_deg = 89;
  const RangeScan free = scan(sphere_ahead(), Rigid3::Identity(), spec);
  const double facet_deg = 180.0 / 160;  // a face's normal differs from the sphere's
  for (const Vector3d& point : limited.cloud.positions)
    EXPECT_LT(incidence_deg(limited, point), 50 + facet_deg);
  std::size_t expected = 0;
  for (const Vector3d& point : free.cloud.positions) expected += incidence_deg(free, point) < 50 - facet_deg;
  EXPECT_GE(limited.cloud.size(), expected);
  EXPECT_LT(limited.cloud.size(), free.cloud.size() * 8 / 10);
}

TEST_P(BothKindsOfRays, GridNeighboursAreNeighbours) {
  const ScannerSpec spec = spec_of(GetParam());
  const RangeScan taken = scan(sphere_ahead(), Rigid3::Identity(), spec);
  ASSERT_TRUE(taken.grid);
  ASSERT_EQ(taken.grid->cells.size(), 90U * 110U);
  std::size_t filled = 0;
  // Two samples' distance on the steepest surface that returns anything.
  const double pitch = spec.rays == Rays::parallel ? spec.pitch_m : distance * spec.pitch_deg * pi / 180;
  const double farthest = 1.2 * pitch / std::cos(spec.max_incidence_deg * pi / 180);
  for (int row = 0; row < 90; ++row)
    for (int column = 0; column < 110; ++column) {
      const std::int32_t here = taken.grid->at(row, column);
      if (here == RangeGrid::missing) continue;
      EXPECT_EQ(static_cast<std::size_t>(here), filled++);
      const Vector3d& p = taken.cloud.positions[static_cast<std::size_t>(here)];
      if (column > 0 && taken.grid->at(row, column - 1) != RangeGrid::missing) {
        const Vector3d& left = taken.cloud.positions[static_cast<std::size_t>(here - 1)];
        EXPECT_LT((p - left).norm(), farthest);
        EXPECT_GT(p.x(), left.x());
      }
      if (row > 0 && taken.grid->at(row - 1, column) != RangeGrid::missing) {
        const Vector3d& above =
            taken.cloud.positions[static_cast<std::size_t>(taken.grid->at(row - 1, column))];
        EXPECT_LT((p - above).norm(), farthest);
        EXPECT_GT(p.y(), above.y());
      }
    }
  EXPECT_EQ(filled, taken.cloud.size());
}

TEST_P(BothKindsOfRays, APoseMovesTheScannerAndNotTheScan) {
  // Seen from elsewhere by a scanner that moved along, the world looks the same.
  const ScannerSpec spec = spec_of(GetParam());
  const TriangleMesh mesh = sphere_ahead();
  const Rigid3 motion = Eigen::Translation3d(3, -2, 1) * Eigen::AngleAxisd(2, Vector3d(1, 2, 3).normalized());
  TriangleMesh moved = mesh;
  for (Vector3d& vertex : moved.vertices) vertex = motion * vertex;
  const RangeScan here = scan(mesh, Rigid3::Identity(), spec);
  const RangeScan there = scan(moved, motion, spec);
  ASSERT_TRUE(there.world_from_scan);
  EXPECT_TRUE(there.world_from_scan->isApprox(motion));
  ASSERT_NEAR(static_cast<double>(here.cloud.size()), static_cast<double>(there.cloud.size()), 5);
  for (int row = 0; row < spec.rows; ++row)
    for (int column = 0; column < spec.columns; ++column) {
      const std::int32_t a = here.grid->at(row, column);
      const std::int32_t b = there.grid->at(row, column);
      if (a == RangeGrid::missing || b == RangeGrid::missing) continue;
      EXPECT_LT((here.cloud.positions[static_cast<std::size_t>(a)] -
                 there.cloud.positions[static_cast<std::size_t>(b)])
                    .norm(),
                1e-9);
    }
}

TEST_P(BothKindsOfRays, TheSameForAnyNumberOfThreads) {
  ScannerSpec spec = spec_of(GetParam());
  spec.noise_m = 0.001;
  spec.mixed_pixel_percent = 50;
  spec.seed = 3;
  const TriangleMesh mesh = sphere_ahead();
  set_thread_count(1);
  const RangeScan one = scan(mesh, Rigid3::Identity(), spec);
  set_thread_count(4);
  const RangeScan four = scan(mesh, Rigid3::Identity(), spec);
  set_thread_count(0);
  EXPECT_EQ(one.cloud.positions, four.cloud.positions);
  EXPECT_EQ(one.grid->cells, four.grid->cells);
  spec.seed = 4;
  EXPECT_NE(scan(mesh, Rigid3::Identity(), spec).cloud.positions, one.cloud.positions);
}

TEST(RangeScanner, DivergingRaysComeFromTheOriginAndParallelOnesAlongZ) {
  const RangeScan diverging = scan(sphere_ahead(), Rigid3::Identity(), spec_of(Rays::diverging));
  EXPECT_EQ(diverging.view.kind, ScanView::Kind::origin);
  EXPECT_EQ(diverging.view.vector, Vector3d::Zero());
  const RangeScan parallel = scan(sphere_ahead(), Rigid3::Identity(), spec_of(Rays::parallel));
  EXPECT_EQ(parallel.view.kind, ScanView::Kind::direction);
  EXPECT_EQ(parallel.view.vector, Vector3d::UnitZ());
  for (int row = 0; row < 90; ++row)
    for (int column = 0; column < 110; ++column) {
      if (const auto i = diverging.grid->at(row, column); i != RangeGrid::missing) {
        const Vector3d& p = diverging.cloud.positions[static_cast<std::size_t>(i)];
        EXPECT_NEAR(std::atan2(p.x(), p.z()) * 180 / pi, 0.3 * (column - 54.5), 1e-9);
        EXPECT_NEAR(std::asin(p.y() / p.norm()) * 180 / pi, 0.3 * (row - 44.5), 1e-9);
      }
      if (const auto i = parallel.grid->at(row, column); i != RangeGrid::missing) {
        const Vector3d& p = parallel.cloud.positions[static_cast<std::size_t>(i)];
        EXPECT_NEAR(p.x(), 0.0025 * (column - 54.5), 1e-12);
        EXPECT_NEAR(p.y(), 0.0025 * (row - 44.5), 1e-12);
      }
    }
}

/// A small plate at z = 0.4 in front of a large one at z = 0.5, as thin boxes.
TriangleMesh plate_before_plate() {
  TriangleMesh mesh = test::box({-0.1, -0.1, 0.5}, {0.1, 0.1, 0.52});
  const TriangleMesh front = test::box({-0.03, -0.03, 0.4}, {0.03, 0.03, 0.41});
  for (const Face& face : front.faces) mesh.faces.push_back({face[0] + 8, face[1] + 8, face[2] + 8});
  mesh.vertices.insert(mesh.vertices.end(), front.vertices.begin(), front.vertices.end());
  return mesh;
}

TEST(RangeScanner, NothingIsSeenBehindSomethingElse) {
  ScannerSpec spec = spec_of(Rays::diverging);
  spec.pitch_deg = 0.1;
  const RangeScan taken = scan(plate_before_plate(), Rigid3::Identity(), spec);
  std::size_t front = 0;
  for (const Vector3d& point : taken.cloud.positions) {
    const bool shadowed = std::abs(point.x() / point.z()) < 0.03 / 0.4 - 1e-9 &&
                          std::abs(point.y() / point.z()) < 0.03 / 0.4 - 1e-9;
    EXPECT_NEAR(point.z(), shadowed ? 0.4 : 0.5, 1e-9);
    front += shadowed ? 1 : 0;
  }
  EXPECT_GT(front, 1000U);
  EXPECT_GT(taken.cloud.size() - front, 1000U);
}

TEST(RangeScanner, MixedPixelsLieBetweenTheSurfacesAndAtTheEdgeOnly) {
  ScannerSpec spec = spec_of(Rays::parallel);
  spec.rows = spec.columns = 150;
  spec.pitch_m = 0.001;
  spec.mixed_pixel_percent = 30;
  spec.max_incidence_deg = 80;
  const RangeScan taken = scan(plate_before_plate(), Rigid3::Identity(), spec);
  int mixed = 0;
  for (const Vector3d& point : taken.cloud.positions) {
    EXPECT_GE(point.z(), 0.4 - 1e-12);
    EXPECT_LE(point.z(), 0.5 + 1e-12);
    if (point.z() < 0.4 + 1e-9 || point.z() > 0.5 - 1e-9) continue;
    ++mixed;
    EXPECT_NEAR(std::max(std::abs(point.x()), std::abs(point.y())), 0.03, 0.0011);
  }
  // Sixty samples a side lie on either side of the front plate's outline: 4 * 60 * 2 and a few at its
  // corners.
  const double expected = 0.3 * 480;
  EXPECT_NEAR(mixed, expected, 4 * std::sqrt(480 * 0.3 * 0.7) + 3);
}

TEST(RangeScanner, ASphereAloneHasNoMixedPixels) {
  ScannerSpec spec = spec_of(Rays::diverging);
  spec.mixed_pixel_percent = 100;
  const RangeScan taken = scan(sphere_ahead(), Rigid3::Identity(), spec);
  for (const Vector3d& point : taken.cloud.positions)
    EXPECT_NEAR((point - Vector3d(0, 0, distance)).norm(), radius, sagitta + 1e-12);
}

TEST(RangeScanner, TheInnerSideReturnsNothing) {
  const RangeScan taken = scan(test::sphere(1, 20), Rigid3::Identity(), spec_of(Rays::diverging));
  EXPECT_TRUE(taken.cloud.empty());
  EXPECT_EQ(taken.grid->cells.size(), 90U * 110U);
}

TEST(RangeScanner, IntensityFallsWithTheCosineAndColourIsTheMeshs) {
  TriangleMesh mesh = sphere_ahead();
  mesh.colors.assign(mesh.vertices.size(), Eigen::Vector3f(0.9F, 0.6F, 0.3F));
  ScannerSpec spec = spec_of(Rays::parallel);
  spec.intensity = true;
  spec.color = true;
  const RangeScan taken = scan(mesh, Rigid3::Identity(), spec);
  ASSERT_EQ(taken.cloud.intensities.size(), taken.cloud.size());
  ASSERT_EQ(taken.cloud.colors.size(), taken.cloud.size());
  for (std::size_t i = 0; i < taken.cloud.size(); ++i) {
    const double cosine = std::cos(incidence_deg(taken, taken.cloud.positions[i]) * pi / 180);
    EXPECT_NEAR(taken.cloud.intensities[i], 0.6 * cosine, 0.6 * pi / 160 + 1e-6);  // faces are flat
    EXPECT_LT((taken.cloud.colors[i] - Eigen::Vector3f(0.9F, 0.6F, 0.3F)).norm(), 1e-6F);
  }
}

}  // namespace
}  // namespace drape::simulation
