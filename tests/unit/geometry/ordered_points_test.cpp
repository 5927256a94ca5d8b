// Neighbours by the tree of boxes against all distances, one by one.
#include "drape/geometry/ordered_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "drape/base/parallel.hpp"
#include "drape/base/random.hpp"

namespace drape {
namespace {

using Points = std::vector<Eigen::Vector3d>;

// Dense and sparse surfaces side by side, lone points, and a lattice with equal distances.
Points uneven(const Eigen::Vector3d& origin) {
  Rng rng(3);
  Points points;
  for (int i = 0; i < 600; ++i) points.push_back(origin + Eigen::Vector3d(rng.normal(), rng.normal(), 0));
  for (int i = 0; i < 600; ++i)
    points.push_back(origin + 0.01 * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()));
  for (int i = 0; i < 15; ++i)
    points.push_back(origin + 300 * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()));
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y) points.push_back(origin + Eigen::Vector3d(10 + x, y, 5));
  return points;
}

std::vector<double> nearest_distances(const Points& points, const Eigen::Vector3d& query, std::size_t count) {
  std::vector<double> distances;
  for (const auto& p : points) distances.push_back((p - query).norm());
  std::sort(distances.begin(), distances.end());
  distances.resize(std::min(count, distances.size()));
  return distances;
}

std::vector<double> sorted_distances(std::span<const Near> near) {
  std::vector<double> distances;
  for (const Near& n : near) distances.push_back(std::sqrt(static_cast<double>(n.squared_distance())));
  std::sort(distances.begin(), distances.end());
  return distances;
}

void expect_near(const std::vector<double>& a, const std::vector<double>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], 1e-5 * (b.back() + b[k]));
}

class OrderedPointsTest : public testing::TestWithParam<double> {};

TEST_P(OrderedPointsTest, NeighborhoodsAreThoseOfBruteForce) {
  const Points points = uneven(GetParam() * Eigen::Vector3d(5, -3, 1));
  const OrderedPoints ordered(points);
  for (const std::size_t count : {std::size_t{1}, std::size_t{17}, std::size_t{5000}}) {
    std::vector<std::vector<double>> found(points.size());
    ordered.for_each_neighborhood(count, [&](std::size_t i, std::span<Near> near) {
      found[ordered.original(i)] = sorted_distances(near);
    });
    for (std::size_t i = 0; i < points.size(); i += 7)
      expect_near(found[i], nearest_distances(points, points[i], count));
  }
}

TEST_P(OrderedPointsTest, NearestAndWithinAreThoseOfBruteForce) {
  const Points points = uneven(GetParam() * Eigen::Vector3d(5, -3, 1));
  const OrderedPoints ordered(points);
  Rng rng(4);
  for (int round = 0; round < 50; ++round) {
    const Eigen::Vector3d query = points[rng.below(points.size())] + Eigen::Vector3d(rng.normal(), 0.1, 0);
    std::vector<Near> found(12);
    found.resize(ordered.nearest(query, found));
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
    expect_near(sorted_distances(found), nearest_distances(points, query, 12));
    for (const double radius : {0.05, 0.5, 400.0}) {
      const double least = nearest_distances(points, query, 1)[0];
      const auto nearest = ordered.nearest_within(query, radius);
      ASSERT_EQ(nearest.has_value(), least < radius) << least;
      if (nearest) expect_near({std::sqrt(static_cast<double>(nearest->squared_distance()))}, {least});
    }
    std::set<std::uint32_t> near;
    ordered.within(query, 0.5, [&](std::uint32_t i) { near.insert(ordered.original(i)); });
    std::set<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < points.size(); ++i)
      if ((points[i] - query).norm() <= 0.5) expected.insert(i);
    EXPECT_EQ(near, expected);
  }
}

INSTANTIATE_TEST_SUITE_P(NearAndFarFromTheOrigin, OrderedPointsTest, testing::Values(0.0, 1e5));

TEST(OrderedPointsTest, NoAndFewPoints) {
  std::vector<Near> found(3);
  EXPECT_EQ(OrderedPoints(Points{}).nearest(Eigen::Vector3d::Zero(), found), 0U);
  const OrderedPoints two(Points{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX()});
  EXPECT_EQ(two.nearest(Eigen::Vector3d::Zero(), found), 2U);
  std::size_t visits = 0;
  two.for_each_neighborhood(3, [&](std::size_t, std::span<Near> near) {
    EXPECT_EQ(near.size(), 2U);
    ++visits;
  });
  EXPECT_EQ(visits, 2U);
}

TEST(OrderedPointsTest, PartOfThePoints) {
  const Points points{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(2, 0, 0)};
  const OrderedPoints ordered(points, {0, 2});
  std::vector<Near> found(1);
  ASSERT_EQ(ordered.nearest(Eigen::Vector3d(0.9, 0, 0), found), 1U);
  EXPECT_EQ(ordered.original(found[0].index()), 0U);
}

}  // namespace
}  // namespace drape
