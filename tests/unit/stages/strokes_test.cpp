#include "strokes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace drape::stages {
namespace {

std::size_t marked(const Image8& picture, std::uint8_t value) {
  return static_cast<std::size_t>(std::count(picture.data().begin(), picture.data().end(), value));
}

TEST(Strokes, LineIsAsWideAsItSays) {
  Image8 picture(60, 40, 1, stencil::unknown);
  draw_line(picture, {{10, 20}, {50, 20}}, 6, stencil::object);
  for (int y = 17; y < 23; ++y) EXPECT_EQ(picture.at(30, y), stencil::object) << y;
  EXPECT_EQ(picture.at(30, 16), stencil::unknown);
  EXPECT_EQ(picture.at(30, 23), stencil::unknown);
  // A rectangle of 40 x 6 with round ends.
  EXPECT_NEAR(static_cast<double>(marked(picture, stencil::object)), 40 * 6 + 28, 8);
}

TEST(Strokes, PointAndThinLineMarkWhatTheyTouch) {
  Image8 picture(20, 20, 1, stencil::unknown);
  draw_line(picture, {{5.5, 5.5}}, 0.1, stencil::background);
  EXPECT_EQ(picture.at(5, 5), stencil::background);
  draw_line(picture, {{0, 0}, {20, 20}}, 0.1, stencil::object);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(picture.at(i, i), stencil::object) << i;
}

TEST(Strokes, OutsideThePictureIsLeftOut) {
  Image8 picture(20, 20, 1, stencil::unknown);
  draw_line(picture, {{-50, -50}, {-10, 80}, {1e9, 1e9}}, 4, stencil::object);
  EXPECT_LT(marked(picture, stencil::object), 400U);
  draw_line(picture, {{-100, 10}, {100, 10}}, 2, stencil::background);
  EXPECT_EQ(marked(picture, stencil::background), 40U);
}

}  // namespace
}  // namespace drape::stages
