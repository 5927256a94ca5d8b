#include "drape/report/views.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support.hpp"

namespace drape::report {
namespace {

TEST(Views, FrameThePointsTightlyAndAlike) {
  const auto points = test::box({10, -2, 5}, {14, 1, 6}).vertices;
  const ViewStyle style{.views = 5, .width_px = 300, .height_px = 200, .filled_percent = 80};
  const auto cameras = cameras_around(points, style);
  ASSERT_EQ(cameras.size(), 5U);
  double most = 0;
  for (const Camera& camera : cameras) {
    EXPECT_EQ(camera.K(0, 0), cameras[0].K(0, 0));
    EXPECT_NEAR(camera.K(0, 0), camera.K(1, 1), 1e-9);
    for (const Eigen::Vector3d& point : points) {
      const Camera::Projected projected = camera.project(point);
      EXPECT_GT(projected.depth, 0);
      most = std::max(
          {most, std::abs(projected.pixel.x() - 150) / 150, std::abs(projected.pixel.y() - 100) / 100});
    }
  }
  EXPECT_NEAR(most, 0.8, 1e-9);
}

TEST(Views, KeepUpUpwardsAndStartAtTheFront) {
  const auto points = test::sphere(1, 8).vertices;
  const Eigen::Vector3d up = Eigen::Vector3d(0.2, 1, 0.1).normalized();
  const Eigen::Vector3d front(1, 0.5, 0);
  const auto cameras = cameras_around(points, {.views = 4, .elevation_deg = 30, .up = up, .front = front});
  const Eigen::Vector3d level = (front - front.dot(up) * up).normalized();
  EXPECT_GT(
      cameras[0].center().normalized().dot((level * std::cos(0.5236) + up * std::sin(0.5236)).normalized()),
      1 - 1e-6);
  for (const Camera& camera : cameras) {
    EXPECT_LT(camera.project(up).pixel.y(), camera.project(Eigen::Vector3d::Zero()).pixel.y());
    EXPECT_NEAR(camera.project(up).pixel.x(), 240, 1e-6);
    EXPECT_NEAR(camera.center().normalized().dot(up), 0.5, 1e-6);
  }
  // Counter-clockwise seen from above.
  EXPECT_GT(level.cross(cameras[1].center()).dot(up), 0);
}

TEST(Views, AnyDirectionMayBeUp) {
  const auto points = test::sphere(1, 6).vertices;
  for (const Eigen::Vector3d& up :
       {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(1, 0, 0),
        Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(0, 0, -3)})
    // A front that is up says nothing: some side is taken.
    for (const Camera& camera : cameras_around(points, {.up = up, .front = up}))
      EXPECT_LT(camera.project(up).pixel.y(), camera.project(Eigen::Vector3d::Zero()).pixel.y());
}

TEST(Views, OnePointAndNoPoints) {
  EXPECT_TRUE(cameras_around({}).empty());
  const std::vector<Eigen::Vector3d> nothing = {{std::nan(""), 0, 0}};
  EXPECT_TRUE(cameras_around(nothing).empty());
  const std::vector<Eigen::Vector3d> one = {{3, 4, 5}};
  for (const Camera& camera : cameras_around(one)) {
    EXPECT_TRUE(camera.K.allFinite());
    EXPECT_LT((camera.project(one[0]).pixel - Eigen::Vector2d(240, 240)).norm(), 1e-3);
  }
}

TEST(Views, WrongStylesAreErrors) {
  const std::vector<Eigen::Vector3d> one = {{3, 4, 5}};
  const auto message = [&](const ViewStyle& style) {
    return test::error_message(ErrorCode::input, [&] { (void)cameras_around(one, style); });
  };
  EXPECT_NE(message({.views = 0}), "");
  EXPECT_NE(message({.width_px = -1}), "");
  EXPECT_NE(message({.elevation_deg = 90}), "");
  EXPECT_NE(message({.up = Eigen::Vector3d::Zero()}), "");
}

}  // namespace
}  // namespace drape::report
