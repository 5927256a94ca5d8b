#include "drape/metrics/stencil_agreement.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "drape/base/parallel.hpp"
#include "support.hpp"

namespace drape::metrics {
namespace {

Image8 rectangle(int width, int height, int left, int top, int right, int bottom) {
  Image8 image(width, height, 1, stencil::background);
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) image.at(x, y) = stencil::object;
  return image;
}

Image8 disc(int size, double radius) {
  Image8 image(size, size, 1, stencil::background);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      if (std::hypot(x + 0.5 - size / 2.0, y + 0.5 - size / 2.0) < radius) image.at(x, y) = stencil::object;
  return image;
}

TEST(StencilOverlap, IsIntersectionOverUnion) {
  const StencilOverlap overlap =
      stencil_overlap(rectangle(40, 40, 10, 10, 20, 20), rectangle(40, 40, 15, 10, 25, 20));
  EXPECT_EQ(overlap.both, 50U);
  EXPECT_EQ(overlap.only_first, 50U);
  EXPECT_EQ(overlap.only_second, 50U);
  EXPECT_DOUBLE_EQ(overlap.percent(), 100.0 / 3);
}

TEST(StencilOverlap, LeavesUnknownPixelsOut) {
  Image8 first = rectangle(40, 40, 10, 10, 20, 20);
  Image8 second = rectangle(40, 40, 15, 10, 25, 20);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x)
      if (x < 15) first.at(x, y) = stencil::unknown;
  for (int y = 0; y < 40; ++y) second.at(20, y) = stencil::unknown;
  const StencilOverlap overlap = stencil_overlap(first, second);
  EXPECT_EQ(overlap.both, 50U);
  EXPECT_EQ(overlap.only_first, 0U);
  EXPECT_EQ(overlap.only_second, 40U);
}

TEST(StencilOverlap, OfEmptyStencilsIsZero) {
  const Image8 none(8, 8, 1, stencil::background);
  EXPECT_EQ(stencil_overlap(none, none).percent(), 0);
  EXPECT_EQ(stencil_overlap(Image8(0, 0, 1), Image8(0, 0, 1)).percent(), 0);
  EXPECT_FALSE(boundary_error_px(none, disc(8, 3)).has_value());
  EXPECT_FALSE(boundary_error_px(Image8(8, 8, 1, stencil::object), disc(8, 3)).has_value());
}

TEST(StencilAgreement, DifferentSizesAreAnError) {
  const auto message =
      test::error_message(ErrorCode::input, [] { (void)stencil_overlap(Image8(4, 5, 1), Image8(5, 4, 1)); });
  EXPECT_NE(message.find("4 x 5 and 5 x 4"), std::string::npos);
  EXPECT_NE(test::error_message(ErrorCode::input,
                                [] { (void)boundary_error_px(Image8(4, 5, 1), Image8(4, 5, 3)); }),
            "");
}

TEST(BoundaryError, IsZeroForEqualStencils) {
  const auto error = boundary_error_px(disc(100, 30), disc(100, 30));
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->max, 0);
  EXPECT_GT(error->count, 400U);
}

TEST(BoundaryError, OfAShiftedBandIsTheShift) {
  // A band over the whole width: the image's border is no outline, so that only the shift remains.
  const auto error = boundary_error_px(rectangle(50, 60, 0, 10, 50, 30), rectangle(50, 60, 0, 14, 50, 34));
  ASSERT_TRUE(error.has_value());
  EXPECT_DOUBLE_EQ(error->mean, 4);
  EXPECT_DOUBLE_EQ(error->percentile_95, 4);
  EXPECT_DOUBLE_EQ(error->max, 4);
}

TEST(BoundaryError, OfConcentricDiscsIsTheDifferenceOfTheRadii) {
  const auto error = boundary_error_px(disc(200, 60), disc(200, 67));
  ASSERT_TRUE(error.has_value());
  EXPECT_NEAR(error->mean, 7, 0.35);  // a pixel outline is within half a diagonal of its circle
  EXPECT_LE(error->max, 7 + std::sqrt(2.0));
}

TEST(BoundaryError, LeavesTheBorderOfTheUnknownOut) {
  const Image8 known = rectangle(60, 60, 10, 10, 50, 50);
  Image8 partly = known;
  for (int y = 0; y < 60; ++y)
    for (int x = 30; x < 60; ++x) partly.at(x, y) = stencil::unknown;
  const auto error = boundary_error_px(known, partly);
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(error->max, 0);
}

TEST(BoundaryError, IsSymmetricAndTheSameForAnyNumberOfThreads) {
  set_thread_count(1);
  const auto one = boundary_error_px(disc(300, 100), rectangle(300, 300, 60, 80, 250, 200));
  set_thread_count(4);
  const auto four = boundary_error_px(rectangle(300, 300, 60, 80, 250, 200), disc(300, 100));
  set_thread_count(0);
  ASSERT_TRUE(one.has_value() && four.has_value());
  EXPECT_EQ(one->mean, four->mean);
  EXPECT_EQ(one->percentile_95, four->percentile_95);
}

}  // namespace
}  // namespace drape::metrics
