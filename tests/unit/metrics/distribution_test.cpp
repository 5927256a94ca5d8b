#include "drape/metrics/distribution.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "drape/base/random.hpp"

namespace drape::metrics {
namespace {

TEST(Distribution, OfOneToTwenty) {
  std::vector<double> values;
  for (int i = 20; i >= 1; --i) values.push_back(i);
  const Distribution d = distribution(values);
  EXPECT_EQ(d.count, 20U);
  EXPECT_DOUBLE_EQ(d.mean, 10.5);
  EXPECT_DOUBLE_EQ(d.rms, std::sqrt(2870.0 / 20));
  EXPECT_EQ(d.median, 10);
  EXPECT_EQ(d.percentile_95, 19);
  EXPECT_EQ(d.max, 20);
}

TEST(Distribution, OfNothingAndOfOneValue) {
  EXPECT_EQ(distribution({}).count, 0U);
  EXPECT_EQ(distribution({}).max, 0);
  const Distribution one = distribution({3.5});
  EXPECT_EQ(one.median, 3.5);
  EXPECT_EQ(one.percentile_95, 3.5);
  EXPECT_EQ(one.rms, 3.5);
}

TEST(Distribution, DoesNotDependOnTheOrder) {
  Rng rng(4);
  std::vector<double> values(1000);
  for (double& value : values) value = std::exp(rng.normal());
  const Distribution before = distribution(values);
  std::reverse(values.begin(), values.end());
  const Distribution after = distribution(values);
  EXPECT_EQ(before.mean, after.mean);
  EXPECT_EQ(before.rms, after.rms);
}

}  // namespace
}  // namespace drape::metrics
