#include "clusters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "backdrop.hpp"
#include "drape/base/random.hpp"
#include "texture_features.hpp"

namespace drape::segmentation {
namespace {

// Three upright bands of L = 20, 50 and 85, a little noisy.
ImageF bands(int width, int height, double noise) {
  ImageF lab(width, height, 3, 0.F);
  Rng rng(5);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double level = x < width / 3 ? 20 : x < 2 * width / 3 ? 50 : 85;
      lab.at(x, y, 0) = static_cast<float>(level + noise * rng.normal());
    }
  return lab;
}

SegmentOptions by(Method method, std::optional<int> clusters) {
  SegmentOptions options;
  options.method = method;
  options.clusters = clusters;
  options.position_weight = 0;
  return options;
}

TEST(Clusters, FindTheThreeBandsByEveryMethod) {
  const ImageF lab = bands(90, 60, 1.5);
  for (const Method method : {Method::kmeans, Method::divisive, Method::agglomerative, Method::em}) {
    const Labels labels = clusters_of(lab, by(method, 3), 1);
    const std::set<std::int32_t> used(labels.data().begin(), labels.data().end());
    EXPECT_EQ(used, (std::set<std::int32_t>{0, 1, 2})) << clustering_name(method);
    for (const int band : {0, 1, 2}) {
      int same = 0;
      for (int y = 0; y < 60; ++y)
        for (int x = 4; x < 26; ++x)
          same += labels.at(30 * band + x, y) == labels.at(30 * band + 15, 30) ? 1 : 0;
      EXPECT_GT(same, 0.99 * 60 * 22) << clustering_name(method);
    }
    EXPECT_NE(labels.at(15, 30), labels.at(45, 30));
    EXPECT_NE(labels.at(45, 30), labels.at(75, 30));
  }
}

TEST(Clusters, TheirNumberIsTheFewestThatExplainTheVariance) {
  const ImageF lab = bands(90, 60, 1.5);  // three levels explain 99.7 %, two of them 86 % at the most
  for (const Method method : {Method::kmeans, Method::divisive, Method::agglomerative}) {
    const Labels labels = clusters_of(lab, by(method, {}), 1);
    EXPECT_EQ(*std::max_element(labels.data().begin(), labels.data().end()), 2) << clustering_name(method);
  }
}

TEST(Texture, IsDirectedInStripesAndOneSidedAtAnEdge) {
  ImageF lab(96, 64, 3, 0.F);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 96; ++x)
      lab.at(x, y, 0) = x < 48 ? ((x / 2) % 2 == 0 ? 30.F : 70.F) : (x < 72 ? 30.F : 70.F);
  const ImageF texture = texture_features(lab);
  EXPECT_GT(texture.at(24, 32, 2), 0.1F);                          // contrast in the stripes
  EXPECT_LT(texture.at(60, 32, 2), 0.01F);                         // none in the flat part
  EXPECT_GT(texture.at(24, 32, 0), 0.9F * texture.at(24, 32, 2));  // upright: anisotropy near 1
  EXPECT_GT(texture.at(72, 32, 1), 0.5F * texture.at(72, 32, 2));  // an edge is polar
  EXPECT_LT(texture.at(24, 32, 1), 0.5F * texture.at(24, 32, 2));  // stripes are not
}

// A backdrop that falls off by 25 in L from one corner to the other, and a disc 20 darker than it.
ImageF falling_off(bool with_disc) {
  ImageF lab(120, 90, 3, 0.F);
  Rng rng(9);
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 120; ++x) {
      const double light = 70 - 25.0 * (x * x + y * y) / (120.0 * 120 + 90 * 90);
      const bool disc = with_disc && (x - 55) * (x - 55) + (y - 45) * (y - 45) < 25 * 25;
      lab.at(x, y, 0) = static_cast<float>((disc ? light - 20 : light) + rng.normal());
    }
  return lab;
}

TEST(Backdrop, OneThatFallsOffIsNoObject) {
  const Backdrop empty = smooth_backdrop(falling_off(false));
  EXPECT_EQ(empty.border_share, 1);
  EXPECT_LT(std::count_if(empty.difference.data().begin(), empty.difference.data().end(),
                          [](float d) { return d > 1; }),
            5);
  const Backdrop disc = smooth_backdrop(falling_off(true));
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 120; ++x) {
      const int r2 = (x - 55) * (x - 55) + (y - 45) * (y - 45);
      if (r2 >= 24 * 24 && r2 <= 26 * 26) continue;
      EXPECT_EQ(disc.difference.at(x, y) > 1, r2 < 24 * 24) << x << " " << y;
    }
}

TEST(Backdrop, AClampThatReachesOverTheBorderDoesNotBendIt) {
  ImageF lab = falling_off(true);
  for (int y = 0; y < 30; ++y)
    for (int x = 50; x < 62; ++x) lab.at(x, y, 0) = 5;
  const Backdrop found = smooth_backdrop(lab);
  EXPECT_NEAR(found.border_share, 1 - 12.0 / 416, 0.01);
  EXPECT_GT(found.difference.at(56, 4), 1);
  EXPECT_LT(found.difference.at(10, 10), 1);
}

// A wall and a floor, each smooth by itself: two colours that a horizon parts.
TEST(Backdrop, OfAWallAndAFloorIsBoth) {
  ImageF lab = falling_off(true);
  for (int y = 60; y < 90; ++y)
    for (int x = 0; x < 120; ++x) lab.at(x, y, 1) += 20;
  for (int y = 40; y < 75; ++y)
    for (int x = 50; x < 70; ++x) lab.at(x, y, 2) = 70;
  const Backdrop found = smooth_backdrop(lab);
  EXPECT_EQ(found.sheets, 2U);
  EXPECT_GT(found.border_share, 0.97);
  EXPECT_GT(found.difference.at(60, 50), 1);
  EXPECT_GT(found.difference.at(60, 65), 1);
  EXPECT_LT(found.difference.at(20, 58), 1);
  EXPECT_LT(found.difference.at(20, 62), 1);
}

}  // namespace
}  // namespace drape::segmentation
