#include "drape/report/scans_picture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "color.hpp"
#include "drape/base/parallel.hpp"
#include "support.hpp"

namespace drape::report {
namespace {

const Eigen::Vector3f white(1, 1, 1);

ScansPictureStyle one_view() {
  ScansPictureStyle style;
  style.view = {.views = 1, .width_px = 120, .height_px = 120, .elevation_deg = 0};
  style.background = white;
  return style;
}

bool is_white(const Image8& image, int x, int y) {
  return image.at(x, y, 0) == 255 && image.at(x, y, 1) == 255 && image.at(x, y, 2) == 255;
}

int covered(const Image8& image) {
  int count = 0;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) count += is_white(image, x, y) ? 0 : 1;
  return count;
}

std::vector<Eigen::Vector3d> square(double y, double half, int steps) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= steps; ++j)
      points.emplace_back(half * (2.0 * i / steps - 1), y, half * (2.0 * j / steps - 1));
  return points;
}

double difference(const Image8& image, int x, int y, const Eigen::Vector3f& color) {
  double most = 0;
  for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(image.at(x, y, c) - 255.0 * color[c]));
  return most;
}

TEST(ScansPicture, ClosesTheGapsBetweenPoints) {
  const auto points = square(0, 1, 20);
  const Image8 picture = scans_picture(std::vector<PlacedScan>{{.positions = points}}, one_view());
  ASSERT_EQ(picture.width(), 120 + 16);
  // The square fills 92 % of the picture: no white pixel within its inner part.
  for (int y = 30; y < 106; ++y)
    for (int x = 30; x < 106; ++x) ASSERT_FALSE(is_white(picture, x, y));
  EXPECT_LE(difference(picture, 68, 68, item_color(0)), 2);
}

TEST(ScansPicture, TheNearerScanHidesTheOther) {
  // The first camera looks along +y.
  const auto near = square(-1, 0.4, 20);
  const auto far = square(1, 1, 30);
  for (const bool near_first : {true, false}) {
    std::vector<PlacedScan> scans = {{.positions = near}, {.positions = far}};
    if (!near_first) std::swap(scans[0], scans[1]);
    const Image8 picture = scans_picture(scans, one_view());
    EXPECT_LE(difference(picture, 68, 68, item_color(near_first ? 0 : 1)), 2);
    EXPECT_LE(difference(picture, 24, 68, item_color(near_first ? 1 : 0)), 2);
  }
}

TEST(ScansPicture, PutsScansWhereTheirPosesSay) {
  const auto points = square(0, 1, 20);
  std::vector<PlacedScan> scans = {{.positions = points}, {.positions = points}};
  scans[1].world_from_scan.translation() = Eigen::Vector3d(4, 0, 0);
  const Image8 picture = scans_picture(scans, one_view());
  EXPECT_LE(difference(picture, 35, 68, item_color(0)), 2);
  EXPECT_LE(difference(picture, 101, 68, item_color(1)), 2);
  EXPECT_TRUE(is_white(picture, 68, 68));
}

TEST(ScansPicture, NormalsShadeBothSidesAlike) {
  const auto points = square(0, 1, 20);
  const auto centre = [&](const Eigen::Vector3f& normal) {
    const std::vector<Eigen::Vector3f> normals(points.size(), normal);
    return scans_picture(std::vector<PlacedScan>{{.positions = points, .normals = normals}}, one_view())
        .at(68, 68, 0);
  };
  EXPECT_EQ(centre({0, 1, 0}), centre({0, -1, 0}));
  EXPECT_LT(centre({1, 0, 0}) + 30, centre({0, 1, 0}));
}

TEST(ScansPicture, DroppedPointsAreRed) {
  const auto points = square(0, 1, 20);
  const auto dropped = square(-0.2, 0.1, 4);
  const Image8 picture =
      scans_picture(std::vector<PlacedScan>{{.positions = points, .dropped = dropped}}, one_view());
  EXPECT_GT(picture.at(68, 68, 0), picture.at(68, 68, 1) + 60);
  EXPECT_GT(picture.at(68, 68, 0), picture.at(68, 68, 2) + 60);
}

TEST(ScansPicture, FarStraysDoNotMakeTheRestSmall) {
  auto points = square(0, 1, 40);
  const int alone = covered(scans_picture(std::vector<PlacedScan>{{.positions = points}}, one_view()));
  points.emplace_back(300, 20, 50);
  points.emplace_back(std::nan(""), 0, 0);
  const int with_stray = covered(scans_picture(std::vector<PlacedScan>{{.positions = points}}, one_view()));
  EXPECT_GT(with_stray, 0.8 * alone);
}

TEST(ScansPicture, IsTheSameForAnyNumberOfThreads) {
  const auto points = test::torus(2, 0.5).vertices;
  const std::vector<PlacedScan> scans = {{.positions = points}};
  set_thread_count(1);
  const Image8 one = scans_picture(scans);
  set_thread_count(4);
  const Image8 four = scans_picture(scans);
  set_thread_count(0);
  EXPECT_EQ(one, four);
}

TEST(ScansPicture, FewOrNoPoints) {
  EXPECT_TRUE(scans_picture({}).empty());
  const std::vector<Eigen::Vector3d> nothing = {{std::nan(""), 0, 0}};
  EXPECT_TRUE(scans_picture(std::vector<PlacedScan>{{.positions = nothing}}).empty());
  const std::vector<Eigen::Vector3d> one = {{1, 2, 3}};
  EXPECT_GT(covered(scans_picture(std::vector<PlacedScan>{{.positions = one}}, one_view())), 0);
  const std::vector<Eigen::Vector3d> same(100, Eigen::Vector3d(1, 2, 3));
  EXPECT_GT(covered(scans_picture(std::vector<PlacedScan>{{.positions = same}}, one_view())), 0);
}

TEST(ScansPicture, NormalsOfAnotherLengthAreAnError) {
  const auto points = square(0, 1, 3);
  const std::vector<Eigen::Vector3f> normals(3, Eigen::Vector3f(0, 1, 0));
  EXPECT_NE(
      test::error_message(
          ErrorCode::input,
          [&] { (void)scans_picture(std::vector<PlacedScan>{{.positions = points, .normals = normals}}); }),
      "");
}

TEST(Color, BytesComeBackFromLight) {
  for (int value = 0; value < 256; ++value) {
    const auto byte = static_cast<std::uint8_t>(value);
    EXPECT_EQ(byte_from_linear(linear_from_byte(byte)), byte);
  }
  EXPECT_EQ(byte_from_linear(-1), 0);
  EXPECT_EQ(byte_from_linear(7), 255);
  // IEC 61966-2-1: half of full light.
  EXPECT_EQ(byte_from_linear(0.5F), 188);
}

TEST(ItemColor, NeighboursAreFarApart) {
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_GT((item_color(i) - item_color(i + 1)).norm(), 0.25) << i;
    EXPECT_GT((item_color(i) - item_color(i + 2)).norm(), 0.15) << i;
  }
}

}  // namespace
}  // namespace drape::report
