#include "drape/report/contact_sheet.hpp"

#include <gtest/gtest.h>

#include "support.hpp"

namespace drape::report {
namespace {

const Eigen::Vector3f black = Eigen::Vector3f::Zero();

TEST(Fitted, KeepsProportionsAndNeverEnlarges) {
  const Image8 wide(400, 100, 3, 7);
  EXPECT_EQ(fitted(wide, 200, 200).width(), 200);
  EXPECT_EQ(fitted(wide, 200, 200).height(), 50);
  EXPECT_EQ(fitted(wide, 1000, 25).width(), 100);
  EXPECT_EQ(fitted(wide, 400, 100), wide);
  EXPECT_EQ(fitted(wide, 4000, 1000), wide);
  EXPECT_EQ(fitted(wide, 2, 2).height(), 1);
  EXPECT_TRUE(fitted(Image8(), 10, 10).empty());
  EXPECT_NE(test::error_message(ErrorCode::input, [&] { (void)fitted(wide, 0, 10); }), "");
}

TEST(Fitted, AveragesLightNotCodes) {
  Image8 board(64, 64, 1);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) board.at(x, y) = (x + y) % 2 == 0 ? 255 : 0;
  const Image8 half = fitted(board, 32, 32);
  // Half the light of white is 188 of 255 in sRGB (IEC 61966-2-1).
  for (const std::uint8_t value : half.data()) EXPECT_EQ(value, 188);
  const Image8 flat(90, 70, 3, 93);
  EXPECT_EQ(fitted(flat, 31, 31), Image8(31, 24, 3, 93));
}

TEST(Fitted, WhatIsTransparentHasNoColour) {
  Image8 picture(2, 2, 4, 0);
  picture.at(0, 0, 0) = 200;
  picture.at(0, 0, 3) = 255;
  picture.at(1, 1, 1) = 255;  // green, but transparent
  const Image8 one = fitted(picture, 1, 1);
  EXPECT_EQ(one.at(0, 0, 0), 200);
  EXPECT_EQ(one.at(0, 0, 1), 0);
  EXPECT_EQ(one.at(0, 0, 3), 64);
}

TEST(ContactSheet, HasEqualCellsWithGapsAllRound) {
  const std::vector<Image8> pictures(5, Image8(40, 20, 3, 200));
  const Image8 sheet = contact_sheet(
      pictures, {.columns = 3, .cell_width_px = 40, .cell_height_px = 30, .gap_px = 4, .background = black});
  ASSERT_EQ(sheet.width(), 3 * 40 + 4 * 4);
  ASSERT_EQ(sheet.height(), 2 * 30 + 3 * 4);
  for (int i = 0; i < 6; ++i) {
    const int left = 4 + i % 3 * 44;
    const int top = 4 + i / 3 * 34 + 5;  // centred: 20 of 30 rows
    const int expected = i < 5 ? 200 : 0;
    EXPECT_EQ(sheet.at(left, top), expected);
    EXPECT_EQ(sheet.at(left + 39, top + 19), expected);
    EXPECT_EQ(sheet.at(left, top - 1), 0);
    EXPECT_EQ(sheet.at(left, top + 20), 0);
  }
  EXPECT_EQ(sheet.at(3, 20), 0);
  EXPECT_EQ(sheet.at(44, 20), 0);
}

TEST(ContactSheet, ChoosesAShapeWithFewEmptyCells) {
  const auto columns = [](std::size_t count) {
    const std::vector<Image8> pictures(count, Image8(10, 10, 1, 9));
    return contact_sheet(pictures, {.cell_width_px = 10, .cell_height_px = 10, .gap_px = 0}).width() / 10;
  };
  EXPECT_EQ(columns(1), 1);
  EXPECT_EQ(columns(2), 2);
  EXPECT_EQ(columns(4), 2);
  EXPECT_EQ(columns(6), 3);
  EXPECT_EQ(columns(8), 4);
}

TEST(ContactSheet, TakesGreyTransparentAndEmptyPictures) {
  Image8 clear(8, 8, 4, 0);
  clear.at(2, 2, 0) = 255;
  clear.at(2, 2, 3) = 255;
  const std::vector<Image8> pictures = {Image8(8, 8, 1, 50), clear, Image8()};
  const Image8 sheet = contact_sheet(
      pictures,
      {.columns = 3, .cell_width_px = 8, .cell_height_px = 8, .gap_px = 0, .background = {1, 1, 1}});
  for (int c = 0; c < 3; ++c) EXPECT_EQ(sheet.at(3, 3, c), 50);
  EXPECT_EQ(sheet.at(10, 2, 0), 255);
  EXPECT_EQ(sheet.at(10, 2, 1), 0);
  EXPECT_EQ(sheet.at(12, 4, 1), 255);
  EXPECT_EQ(sheet.at(20, 4, 1), 255);
}

TEST(ContactSheet, OfNothingIsNothing) {
  EXPECT_TRUE(contact_sheet({}).empty());
  const std::vector<Image8> one(1, Image8(2, 2, 3));
  EXPECT_NE(test::error_message(ErrorCode::input, [&] { (void)contact_sheet(one, {.cell_width_px = 0}); }),
            "");
  EXPECT_NE(test::error_message(ErrorCode::input, [&] { (void)contact_sheet(one, {.gap_px = -1}); }), "");
}

}  // namespace
}  // namespace drape::report
