#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "area_prefilter.hpp"
#include "drape/base/random.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "edge_splits.hpp"
#include "grown_photo.hpp"
#include "linear_light.hpp"
#include "photo_colors.hpp"
#include "support.hpp"
#include "usable_pixels.hpp"

namespace drape::texturing {
namespace {

TEST(LinearLight, GoesThereAndBackForEveryByte) {
  for (int i = 0; i < 256; ++i)
    EXPECT_EQ(byte_from_linear(linear_from_byte(static_cast<std::uint8_t>(i))), i);
  EXPECT_NEAR(linear_from_byte(188), 0.5029, 1e-3);  // half the light is stored as 188
}

TEST(AreaPrefilter, MeansOfItsNeighboursAreThePictureAgain) {
  Image8 photo(23, 17, 3);
  Rng rng(5);
  for (std::uint8_t& value : photo.data()) value = static_cast<std::uint8_t>(120 + rng.below(30));
  Image8 sharp = photo;
  prefilter_areas(sharp);
  const auto light = [&](int x, int y, int c) {  // mirrored about the first and the last pixel
    const auto mirrored = [](int i, int size) { return i < 0 ? -i : i >= size ? 2 * size - 2 - i : i; };
    return linear_from_byte(sharp.at(mirrored(x, 23), mirrored(y, 17), c));
  };
  const std::array<float, 3> share = {1 / 16.F, 7 / 8.F, 1 / 16.F};
  int largest = 0;
  for (int y = 0; y < 17; ++y)
    for (int x = 0; x < 23; ++x)
      for (int c = 0; c < 3; ++c) {
        float sum = 0;
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx)
            sum += share[static_cast<std::size_t>(dx + 1)] * share[static_cast<std::size_t>(dy + 1)] *
                   light(x + dx, y + dy, c);
        largest = std::max(largest, std::abs(int{byte_from_linear(sum)} - photo.at(x, y, c)));
      }
  EXPECT_LE(largest, 1);
  EXPECT_NE(sharp, photo);
  Image8 flat(1, 40, 3, 77);
  prefilter_areas(flat);
  EXPECT_EQ(flat, Image8(1, 40, 3, 77));
}

TEST(PhotoColors, WavesKeepTheirHeightBetweenPixels) {
  constexpr int period = 8;
  Image8 photo(8 * period, 8 * period, 3);
  for (int y = 0; y < photo.height(); ++y)
    for (int x = 0; x < photo.width(); ++x)
      for (int c = 0; c < 3; ++c)
        photo.at(x, y, c) =
            byte_from_linear(static_cast<float>(0.5 + 0.3 * std::cos(2 * std::numbers::pi * x / period)));
  const Image8 trusted(photo.width(), photo.height(), 1, trust::full);
  const PhotoColors colors({&photo}, trusted);
  const float height = colors.at({4 * period + 0.5, 30.5})[0] - 0.5F;
  EXPECT_GT(height, 0.3F);  // prefiltered
  for (int i = 0; i < period; ++i) {
    // Half way between two pixels; straight lines would lose 0.08 of the height there.
    const double truth = 0.5 + height * std::cos(2 * std::numbers::pi * (i + 0.5) / period);
    EXPECT_NEAR(colors.at({4 * period + i + 1.0, 30.5})[0], truth, 0.02 * height);
    EXPECT_NEAR(colors.at({4 * period + i + 1.0, 31.0})[0], truth, 0.02 * height);
  }
}

TEST(UsablePixels, KeepsTheDistanceFromTheBackground) {
  Image8 shape(20, 9, 1, stencil::object);
  for (int y = 0; y < 9; ++y)
    for (int x = 12; x < 20; ++x) shape.at(x, y) = x == 12 ? stencil::unknown : stencil::background;
  const Image8 trusted = usable_pixels(shape, 20, 9, 2, 3);
  for (int x = 0; x < 20; ++x)  // the outline is at 12; the photo's own border is none
    EXPECT_EQ(trusted.at(x, 0), x < 10 ? trust::full : x < 13 ? trust::near : trust::none) << x;
  EXPECT_EQ(usable_pixels(shape, 20, 9, 0, 0).at(11, 4), trust::full);
  EXPECT_EQ(usable_pixels(shape, 20, 9, 0, 0).at(12, 4), trust::none);
  EXPECT_EQ(usable_pixels({}, 20, 9, 5, 0), Image8(20, 9, 1, trust::full));
}

// Small and large radii, which are reckoned differently, against all distances.
TEST(UsablePixels, AreAsFarFromTheBackgroundAsAsked) {
  constexpr int width = 90;
  constexpr int height = 70;
  Rng rng(4);
  Image8 shape(width, height, 1, stencil::object);
  for (int i = 0; i < 3; ++i)
    shape.at(static_cast<int>(rng.below(width)), static_cast<int>(rng.below(height))) = stencil::unknown;
  for (int x = 0; x < 40; ++x) shape.at(x, 69) = stencil::background;
  for (const auto& [erode, fill] : {std::pair{0.0, 0.0}, {1.5, 6.0}, {2.3, 0.7}, {30.0, 6.0}, {2.0, 26.0}}) {
    const Image8 trusted = usable_pixels(shape, width, height, erode, fill);
    const auto nearest = [&](int x, int y, auto of_kind) {
      double least = 1e9;
      for (int v = 0; v < height; ++v)
        for (int u = 0; u < width; ++u)
          if (of_kind(u, v)) least = std::min(least, std::hypot(u - x, v - y));
      return least;
    };
    for (int y = 0; y < height; y += 3)
      for (int x = 0; x < width; ++x) {
        const bool full =
            nearest(x, y, [&](int u, int v) { return shape.at(u, v) != stencil::object; }) >= erode + 0.5;
        EXPECT_EQ(trusted.at(x, y) == trust::full, full) << x << ", " << y << ": " << erode;
        if (full) continue;
        const double beyond = nearest(x, y, [&](int u, int v) { return trusted.at(u, v) == trust::full; });
        EXPECT_EQ(trusted.at(x, y) == trust::near, beyond <= fill) << x << ", " << y << ": " << fill;
      }
  }
}

TEST(GrownPhoto, GrowsAFlatColourOverTheWholeRest) {
  Image8 photo(37, 23, 3, 0);
  Image8 trusted(37, 23, 1, trust::none);
  for (int y = 5; y < 9; ++y)
    for (int x = 20; x < 22; ++x) {
      trusted.at(x, y) = trust::full;
      for (int c = 0; c < 3; ++c) photo.at(x, y, c) = static_cast<std::uint8_t>(60 + 70 * c);
    }
  const Image8 grown = grown_photo(photo, trusted, {3, 2, 36, 22});
  ASSERT_EQ(grown.width(), 33);
  for (int y = 0; y < grown.height(); ++y)
    for (int x = 0; x < grown.width(); ++x)
      for (int c = 0; c < 3; ++c) ASSERT_EQ(grown.at(x, y, c), 60 + 70 * c);
}

TEST(GrownPhoto, KeepsTrustedBytesAndBlendsInLinearLight) {
  Image8 photo(3, 1, 3, 0);
  for (int c = 0; c < 3; ++c) photo.at(2, 0, c) = 255;
  Image8 trusted(3, 1, 1, trust::full);
  trusted.at(1, 0) = trust::none;
  const Image8 grown = grown_photo(photo, trusted, {0, 0, 3, 1});
  EXPECT_EQ(grown.at(0, 0), 0);
  EXPECT_EQ(grown.at(2, 0), 255);
  EXPECT_GT(grown.at(1, 0),
            110);  // a quarter to a half of the light: stored 137 to 188, never the 64 of bytes
  EXPECT_LT(grown.at(1, 0), 200);
}

TEST(GrownPhoto, StripesGoOnAsNarrowAsTheyAre) {
  constexpr int known = 12;  // columns
  Image8 photo(24, 20, 3, 0);
  Image8 trusted(24, 20, 1, trust::none);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < known; ++x) {
      trusted.at(x, y) = trust::full;
      for (int c = 0; c < 3; ++c) photo.at(x, y, c) = y == 9 ? 220 : 20;
    }
  const Image8 grown = grown_photo(photo, trusted, {0, 0, 24, 20});
  for (int y = 0; y < 20; ++y)
    if (y == 9)
      EXPECT_GT(grown.at(known, y), 140);
    else
      EXPECT_LT(grown.at(known, y), 130) << y;
  EXPECT_EQ(grown.at(known, 4), 20);
  EXPECT_EQ(grown.at(known + 2, 4), 20);
}

TEST(GrownPhoto, WithoutATrustedPixelIsThePhoto) {
  const Image8 photo(5, 4, 3, 99);
  EXPECT_EQ(grown_photo(photo, Image8(5, 4, 1, trust::none), {0, 0, 5, 4}), photo);
}

TEST(SplitEdges, CutsBothSidesOfEveryEdgeAndKeepsTheSurface) {
  TriangleMesh box = test::box({0, 0, 0}, {1, 2, 3});
  box.filled.assign(box.faces.size(), 0);
  box.filled[4] = 1;
  for (const Eigen::Vector3d& x : box.vertices)
    box.colors.push_back((x.cwiseQuotient(Eigen::Vector3d(1, 2, 3))).cast<float>());
  std::vector<EdgeSplit> splits;
  for (const Face& f : box.faces)  // every third edge somewhere, so that faces with 0 to 3 cuts occur
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = std::min(f[k], f[(k + 1) % 3]);
      const std::uint32_t b = std::max(f[k], f[(k + 1) % 3]);
      if ((a * 7 + b * 3) % 5 < 3) splits.push_back({a, b, 0.3});
    }
  const SplitMesh split = split_edges(box, splits);
  EXPECT_TRUE(mesh_topology(split.mesh).closed_manifold());
  EXPECT_EQ(mesh_topology(split.mesh).euler_characteristic, 2);
  EXPECT_NEAR(surface_area(split.mesh), 22, 1e-12);
  EXPECT_NEAR(signed_volume(split.mesh), 6, 1e-12);
  EXPECT_EQ(problem_of(split.mesh), "");
  for (std::size_t f = 0; f < split.mesh.faces.size(); ++f) {
    EXPECT_EQ(split.mesh.filled[f], box.filled[split.parents[f]]);
    const Eigen::Vector3d parent = scaled_face_normal(box, split.parents[f]).normalized();
    EXPECT_GT(scaled_face_normal(split.mesh, f).normalized().dot(parent), 1 - 1e-12);
  }
}

TEST(SplitEdges, TheFirstOfTwoSplitsCountsAndColoursMixInLinearLight) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.faces = {{0, 1, 2}};
  mesh.colors = {{0, 0, 0}, {1, 1, 1}, {0, 0, 0}};
  const std::vector<EdgeSplit> splits = {{0, 1, 0.5}, {0, 1, 0.9}};
  const SplitMesh split = split_edges(mesh, splits);
  ASSERT_EQ(split.mesh.vertices.size(), 4U);
  EXPECT_EQ(split.mesh.vertices[3], Eigen::Vector3d(0.5, 0, 0));
  EXPECT_NEAR(split.mesh.colors[3].x(), 188 / 255.0, 0.002);
}

}  // namespace
}  // namespace drape::texturing
