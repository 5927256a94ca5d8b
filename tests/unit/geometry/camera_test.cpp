#include "drape/geometry/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace drape {
namespace {

Camera slanted_camera() {
  return look_at({3, -4, 2}, {0.1, 0.2, 0.3}, Eigen::Vector3d::UnitZ(), 640, 480, 40);
}

TEST(Camera, LooksAtItsTargetWithUpUpwards) {
  const Camera camera = slanted_camera();
  const Camera::Projected target = camera.project({0.1, 0.2, 0.3});
  EXPECT_NEAR(target.pixel.x(), 320, 1e-9);
  EXPECT_NEAR(target.pixel.y(), 240, 1e-9);
  EXPECT_NEAR(target.depth, Eigen::Vector3d(2.9, -4.2, 1.7).norm(), 1e-12);
  EXPECT_LT(camera.project({0.1, 0.2, 0.5}).pixel.y(), 240);  // higher in the world is higher in the picture
  EXPECT_NEAR(camera.camera_from_world.linear().determinant(), 1.0, 1e-12);
}

TEST(Camera, FieldOfViewReachesTheBorder) {
  const Camera camera = look_at({0, 0, -1}, {0, 0, 0}, -Eigen::Vector3d::UnitY(), 100, 50, 60);
  EXPECT_NEAR(camera.project({std::tan(std::numbers::pi / 6), 0, 0}).pixel.x(), 100, 1e-9);
}

TEST(Camera, PAgreesWithProjectAndUnprojectInvertsIt) {
  for (const auto projection : {Camera::Projection::perspective, Camera::Projection::orthographic}) {
    Camera camera = slanted_camera();
    camera.projection = projection;
    const Eigen::Vector3d point(0.3, -0.2, 0.7);
    const Camera::Projected projected = camera.project(point);
    const Eigen::Vector3d homogeneous = camera.P() * point.homogeneous();
    EXPECT_LT((homogeneous.hnormalized() - projected.pixel).norm(), 1e-9);
    EXPECT_LT((camera.unproject(projected.pixel, projected.depth) - point).norm(), 1e-12);
  }
}

TEST(Camera, OrthographicRaysAreParallel) {
  Camera camera = slanted_camera();
  camera.projection = Camera::Projection::orthographic;
  EXPECT_LT((camera.towards_camera({0, 0, 0}) - camera.towards_camera({5, 5, 5})).norm(), 1e-15);
  const Eigen::Vector3d along = camera.towards_camera({0, 0, 0});
  EXPECT_LT((camera.project(Eigen::Vector3d(0.1, 0, 0)).pixel -
             camera.project(Eigen::Vector3d(0.1, 0, 0) + along).pixel)
                .norm(),
            1e-9);
}

TEST(Camera, ResizedKeepsWhereThingsAre) {
  const Camera camera = slanted_camera();
  const Camera small = camera.resized(320, 120);
  const Eigen::Vector2d full = camera.project({0.5, 0.5, 0.5}).pixel;
  const Eigen::Vector2d half = small.project({0.5, 0.5, 0.5}).pixel;
  EXPECT_NEAR(half.x(), full.x() / 2, 1e-9);
  EXPECT_NEAR(half.y(), full.y() / 4, 1e-9);
}

TEST(Camera, IsFoundAgainInItsMatrix) {
  for (const Camera::Projection projection :
       {Camera::Projection::perspective, Camera::Projection::orthographic}) {
    Camera camera = slanted_camera();
    camera.projection = projection;
    camera.K(1, 1) *= 1.25;
    camera.K(0, 1) = 3;
    for (const double factor : {1.0, -0.5}) {
      const std::optional<Camera> found = camera_from_matrix(factor * camera.P(), 640, 480);
      ASSERT_TRUE(found.has_value());
      EXPECT_EQ(found->projection, projection);
      EXPECT_LT((found->K - camera.K).norm(), 1e-9);
      EXPECT_LT((found->camera_from_world.linear() - camera.camera_from_world.linear()).norm(), 1e-12);
      EXPECT_LT((found->P() - camera.P()).norm(), 1e-9);
    }
  }
  EXPECT_FALSE(camera_from_matrix(Eigen::Matrix<double, 3, 4>::Zero(), 640, 480).has_value());
}

}  // namespace
}  // namespace drape
