#include "drape/alignment/overlap.hpp"

#include <gtest/gtest.h>

#include "support.hpp"

namespace drape::alignment {
namespace {

Image8 of(const std::vector<std::uint8_t>& row) {
  Image8 image(static_cast<int>(row.size()), 1, 1);
  image.data() = row;
  return image;
}

TEST(Overlap, IsTheShareOfCommonPixels) {
  EXPECT_DOUBLE_EQ(overlap_percent(of({255, 255, 255, 0}), of({0, 255, 255, 255})), 50);
  EXPECT_DOUBLE_EQ(overlap_percent(of({255, 0}), of({255, 0})), 100);
  EXPECT_DOUBLE_EQ(overlap_percent(of({255, 0}), of({0, 255})), 0);
  EXPECT_DOUBLE_EQ(overlap_percent(of({0, 0}), of({0, 0})), 0);
}

TEST(Overlap, LeavesOutWhatIsUnknownInEither) {
  EXPECT_DOUBLE_EQ(overlap_percent(of({255, 128, 255, 0}), of({255, 255, 128, 0})), 100);
  EXPECT_DOUBLE_EQ(overlap_percent(of({128, 128}), of({255, 0})), 0);
}

TEST(Overlap, RefusesStencilsOfDifferentSize) {
  EXPECT_FALSE(test::error_message(ErrorCode::input, [] {
                 (void)overlap_percent(of({0, 0}), of({0}));
               }).empty());
}

}  // namespace
}  // namespace drape::alignment
