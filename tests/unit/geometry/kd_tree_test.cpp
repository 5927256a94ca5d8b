#include "drape/geometry/kd_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "drape/base/random.hpp"

namespace drape {
namespace {

std::vector<Eigen::Vector3d> random_points(std::size_t count, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < count; ++i) points.emplace_back(rng.uniform(), rng.uniform(), rng.uniform());
  return points;
}

std::vector<Neighbor> by_brute_force(const std::vector<Eigen::Vector3d>& points,
                                     const Eigen::Vector3d& query) {
  std::vector<Neighbor> all;
  for (std::uint32_t i = 0; i < points.size(); ++i) all.push_back({i, (points[i] - query).squaredNorm()});
  std::sort(all.begin(), all.end(), [](const Neighbor& a, const Neighbor& b) {
    return a.squared_distance < b.squared_distance ||
           (a.squared_distance == b.squared_distance && a.index < b.index);
  });
  return all;
}

TEST(KdTree, AgreesWithBruteForce) {
  const auto points = random_points(2000, 1);
  const KdTree tree(points);
  for (const Eigen::Vector3d& query : random_points(50, 2)) {
    const auto expected = by_brute_force(points, query);
    const auto found = tree.nearest(query, 12);
    ASSERT_EQ(found.size(), 12U);
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].index, expected[i].index);
    const auto near = tree.within(query, 0.1);
    const auto inside = std::count_if(expected.begin(), expected.end(),
                                      [](const Neighbor& n) { return n.squared_distance < 0.01; });
    EXPECT_EQ(near.size(), static_cast<std::size_t>(inside));
    for (std::size_t i = 0; i < near.size(); ++i) EXPECT_EQ(near[i].index, expected[i].index);
  }
}

TEST(KdTree, NearestWithinARadiusIsTheNearestOrNothing) {
  const auto points = random_points(2000, 1);
  const KdTree tree(points);
  for (const Eigen::Vector3d& query : random_points(200, 5)) {
    const Neighbor nearest = by_brute_force(points, query)[0];
    const auto found = tree.nearest_within(query, 0.05);
    EXPECT_EQ(found.has_value(), nearest.squared_distance < 0.05 * 0.05);
    if (found) {
      EXPECT_EQ(found->index, nearest.index);
    }
  }
  EXPECT_FALSE(KdTree(std::vector<Eigen::Vector3d>{}).nearest_within({0, 0, 0}, 1).has_value());
}

TEST(KdTree, TiesGoToTheLowerIndex) {
  const std::vector<Eigen::Vector3d> points(40, Eigen::Vector3d(1, 2, 3));
  const auto found = KdTree(points).nearest({0, 0, 0}, 5);
  ASSERT_EQ(found.size(), 5U);
  for (std::uint32_t i = 0; i < 5; ++i) EXPECT_EQ(found[i].index, i);
}

TEST(KdTree, FewOrNoPoints) {
  const std::vector<Eigen::Vector3d> none;
  EXPECT_TRUE(KdTree(none).nearest({0, 0, 0}, 3).empty());
  EXPECT_TRUE(KdTree(none).within({0, 0, 0}, 1).empty());
  const auto two = random_points(2, 3);
  EXPECT_EQ(KdTree(two).nearest({0, 0, 0}, 5).size(), 2U);
}

}  // namespace
}  // namespace drape
