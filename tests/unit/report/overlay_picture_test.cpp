#include "drape/report/overlay_picture.hpp"

#include <gtest/gtest.h>

#include "drape/base/parallel.hpp"
#include "support.hpp"

namespace drape::report {
namespace {

Image8 rectangle(int left, int top, int right, int bottom) {
  Image8 image(300, 200, 1, stencil::background);
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) image.at(x, y) = stencil::object;
  return image;
}

const Image8 grey(300, 200, 3, 120);
const Image8 none(300, 200, 1, stencil::background);

bool is_orange(const Image8& image, int x, int y) {
  return image.at(x, y, 0) > image.at(x, y, 2) + 60 && image.at(x, y, 0) > image.at(x, y, 1) + 30;
}
bool is_blue(const Image8& image, int x, int y) {
  return image.at(x, y, 2) > image.at(x, y, 0) + 60;
}
bool is_grey(const Image8& image, int x, int y) {
  return image.at(x, y, 0) == image.at(x, y, 1) && image.at(x, y, 1) == image.at(x, y, 2);
}

TEST(OverlayPicture, TintsWhatOnlyOneCoversAndDimsTheRest) {
  const Image8 picture = overlay_picture(grey, rectangle(50, 50, 150, 150), rectangle(100, 50, 200, 150));
  EXPECT_TRUE(is_orange(picture, 75, 100));
  EXPECT_TRUE(is_blue(picture, 175, 100));
  // Both: the photo as it is. Neither: darker, but not gone.
  for (int c = 0; c < 3; ++c) EXPECT_EQ(picture.at(125, 100, c), 120);
  EXPECT_TRUE(is_grey(picture, 20, 20));
  EXPECT_LT(picture.at(20, 20), 80);
  EXPECT_GT(picture.at(20, 20), 30);
}

TEST(OverlayPicture, LinesRunAlongTheOutlines) {
  const Image8 picture = overlay_picture(grey, rectangle(50, 50, 150, 150), rectangle(60, 50, 160, 150));
  for (const int y : {80, 100, 120}) {
    EXPECT_TRUE(is_orange(picture, 49, y) && is_orange(picture, 50, y));
    EXPECT_TRUE(is_blue(picture, 159, y) || is_blue(picture, 160, y));
    EXPECT_TRUE(is_blue(picture, 59, y) || is_blue(picture, 60, y));
    EXPECT_TRUE(is_grey(picture, 44, y));
    EXPECT_TRUE(is_grey(picture, 165, y));
  }
}

TEST(OverlayPicture, BothLinesShowWhereTheyRunTogether) {
  const Image8 both = overlay_picture(grey, rectangle(50, 50, 150, 150), rectangle(50, 50, 150, 150));
  bool orange = false;
  bool blue = false;
  for (int x = 45; x < 55; ++x) {
    orange |= is_orange(both, x, 100);
    blue |= is_blue(both, x, 100);
  }
  EXPECT_TRUE(orange);
  EXPECT_TRUE(blue);
}

TEST(OverlayPicture, NeverTintsWhatIsUnknown) {
  Image8 image = rectangle(50, 50, 150, 150);
  for (int y = 0; y < 200; ++y)
    for (int x = 170; x < 300; ++x) image.at(x, y) = stencil::unknown;
  const Image8 picture = overlay_picture(grey, image, rectangle(50, 50, 250, 150));
  EXPECT_TRUE(is_blue(picture, 160, 100));
  EXPECT_TRUE(is_grey(picture, 210, 100));
  EXPECT_EQ(picture.at(210, 100), 120);
}

TEST(OverlayPicture, OneStencilAloneIsDrawnWithoutTints) {
  const Image8 image_only = overlay_picture(grey, rectangle(50, 50, 150, 150), Image8());
  EXPECT_EQ(image_only.at(100, 100, 0), 120);
  EXPECT_TRUE(is_orange(image_only, 50, 100) || is_orange(image_only, 49, 100));
  const Image8 model_only = overlay_picture(grey, Image8(), rectangle(50, 50, 150, 150));
  EXPECT_EQ(model_only.at(100, 100, 0), 120);
  EXPECT_TRUE(is_blue(model_only, 50, 100) || is_blue(model_only, 49, 100));
}

TEST(OverlayPicture, NoOutlineNoLine) {
  const Image8 nothing = overlay_picture(grey, none, none);
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 300; ++x) ASSERT_TRUE(is_grey(nothing, x, y));
  const Image8 all(300, 200, 1, stencil::object);
  EXPECT_EQ(overlay_picture(grey, all, all), grey);
  EXPECT_TRUE(overlay_picture(Image8(0, 0, 3), Image8(), Image8()).empty());
}

TEST(OverlayPicture, LinesGrowWithThePhoto) {
  const auto line_pixels = [](int size) {
    Image8 stencil(size, size, 1, stencil::background);
    for (int y = 0; y < size; ++y)
      for (int x = size / 2; x < size; ++x) stencil.at(x, y) = stencil::object;
    const Image8 picture = overlay_picture(Image8(size, size, 3, 120), stencil, Image8());
    int count = 0;
    for (int x = 0; x < size; ++x) count += is_orange(picture, x, size / 2) ? 1 : 0;
    return count;
  };
  EXPECT_GE(line_pixels(200), 1);
  EXPECT_NEAR(line_pixels(2000), 4, 1);
}

TEST(OverlayPicture, IsTheSameForAnyNumberOfThreads) {
  set_thread_count(1);
  const Image8 one = overlay_picture(grey, rectangle(50, 50, 150, 150), rectangle(60, 40, 160, 150));
  set_thread_count(4);
  const Image8 four = overlay_picture(grey, rectangle(50, 50, 150, 150), rectangle(60, 40, 160, 150));
  set_thread_count(0);
  EXPECT_EQ(one, four);
}

TEST(OverlayPicture, WrongSizesAreErrors) {
  const auto message = [](auto call) { return test::error_message(ErrorCode::input, call); };
  EXPECT_NE(message([] { (void)overlay_picture(none, none, none); }).find("3 channels"), std::string::npos);
  EXPECT_NE(message([] { (void)overlay_picture(grey, Image8(300, 199, 1), none); }).find("image stencil"),
            std::string::npos);
  EXPECT_NE(message([] { (void)overlay_picture(grey, none, grey); }).find("model stencil"),
            std::string::npos);
}

}  // namespace
}  // namespace drape::report
