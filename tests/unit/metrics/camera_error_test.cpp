#include "drape/metrics/camera_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "drape/metrics/reprojection_error.hpp"
#include "support.hpp"

namespace drape::metrics {
namespace {

constexpr double rad = std::numbers::pi / 180;
const Eigen::Vector3d object_center(0.1, 0.2, 0.3);

Camera true_camera() {
  return look_at({3, -4, 2}, object_center, Eigen::Vector3d::UnitZ(), 640, 480, 40);
}

// The camera turned about its own centre, in its own axes.
Camera turned(Camera camera, double angle_deg, const Eigen::Vector3d& axis) {
  camera.camera_from_world = Rigid3(Eigen::AngleAxisd(angle_deg * rad, axis)) * camera.camera_from_world;
  return camera;
}

// The camera carried round the object.
Camera carried(Camera camera, double angle_deg, const Eigen::Vector3d& axis) {
  Rigid3 motion = Rigid3::Identity();
  motion.translate(object_center);
  motion.rotate(Eigen::AngleAxisd(angle_deg * rad, axis));
  motion.translate(-object_center);
  camera.camera_from_world = camera.camera_from_world * motion.inverse();
  return camera;
}

TEST(CameraError, IsZeroForTheSameCamera) {
  const CameraError error = camera_error(true_camera(), true_camera(), object_center);
  EXPECT_NEAR(error.rotation_deg, 0, 1e-12);
  EXPECT_NEAR(error.rotation_about_ray_deg, 0, 1e-12);
  EXPECT_NEAR(error.direction_deg, 0, 1e-12);
  EXPECT_EQ(error.center_distance, 0.0);
  EXPECT_EQ(error.focal_percent, 0.0);
}

TEST(CameraError, RollCountsInBothRotations) {
  for (const double angle_deg : {1e-5, 0.5, 30.0, 170.0}) {
    const CameraError error = camera_error(turned(true_camera(), angle_deg, Eigen::Vector3d::UnitZ()),
                                           true_camera(), object_center);
    EXPECT_NEAR(error.rotation_deg, angle_deg, 1e-9);
    EXPECT_NEAR(error.rotation_about_ray_deg, angle_deg, 1e-9);
    EXPECT_NEAR(error.direction_deg, 0, 1e-9);
  }
}

TEST(CameraError, PanningCountsInTheAbsoluteRotationOnly) {
  const CameraError error =
      camera_error(turned(true_camera(), 7, Eigen::Vector3d::UnitY()), true_camera(), object_center);
  EXPECT_NEAR(error.rotation_deg, 7, 1e-9);
  EXPECT_NEAR(error.rotation_about_ray_deg, 0, 1e-9);
  EXPECT_NEAR(error.direction_deg, 0, 1e-9);
  EXPECT_NEAR(error.center_distance.value(), 0, 1e-12);
}

TEST(CameraError, CarryingTheCameraRoundTheObjectCountsInAll) {
  const Camera truth = true_camera();
  // Round an axis at right angles to the view: the direction changes by the whole angle.
  const Eigen::Vector3d axis = truth.camera_from_world.linear().row(1);
  const CameraError error = camera_error(carried(truth, 11, axis), truth, object_center);
  EXPECT_NEAR(error.rotation_deg, 11, 1e-9);
  EXPECT_NEAR(error.rotation_about_ray_deg, 11, 1e-9);
  EXPECT_NEAR(error.direction_deg, 11, 1e-9);
  const double distance = (truth.center() - object_center).norm();
  EXPECT_NEAR(error.center_distance.value(), 2 * distance * std::sin(5.5 * rad), 1e-9);
}

TEST(CameraError, FocalErrorIsSignedAndAtOneImageSize) {
  Camera longer = true_camera();
  longer.K.topLeftCorner<2, 2>() *= 1.05;
  EXPECT_NEAR(camera_error(longer, true_camera(), object_center).focal_percent.value(), 5, 1e-9);
  const Camera small = true_camera().resized(320, 240);
  EXPECT_NEAR(camera_error(small, true_camera(), object_center).focal_percent.value(), 0, 1e-9);
  Camera two = true_camera();
  two.K(0, 0) *= 1.21;
  EXPECT_NEAR(camera_error(two, true_camera(), object_center).focal_percent.value(), 10, 1e-9);
}

TEST(CameraError, OrthographicCamerasHaveNoCentre) {
  Camera flat = true_camera();
  flat.projection = Camera::Projection::orthographic;
  const CameraError mixed = camera_error(flat, true_camera(), object_center);
  EXPECT_FALSE(mixed.center_distance.has_value());
  EXPECT_FALSE(mixed.focal_percent.has_value());
  EXPECT_NEAR(mixed.direction_deg, 0, 1e-9);
  const CameraError error = camera_error(turned(flat, 7, Eigen::Vector3d::UnitY()), flat, object_center);
  EXPECT_NEAR(error.rotation_about_ray_deg, 7, 1e-9);  // turning it does show another side
  EXPECT_NEAR(error.direction_deg, 7, 1e-9);
}

TEST(CameraError, DoesNotDependOnTheWorldFrame) {
  Rigid3 new_from_old = Rigid3::Identity();
  new_from_old.rotate(Eigen::AngleAxisd(2, Eigen::Vector3d(1, -1, 3).normalized()));
  new_from_old.pretranslate(Eigen::Vector3d(10, 20, -5));
  const Camera found = turned(carried(true_camera(), 9, {0.6, 0, 0.8}), 3, {0, 0.6, 0.8});
  const auto in_new = [&](Camera camera) {
    camera.camera_from_world = camera.camera_from_world * new_from_old.inverse();
    return camera;
  };
  const CameraError before = camera_error(found, true_camera(), object_center);
  const CameraError after = camera_error(in_new(found), in_new(true_camera()), new_from_old * object_center);
  EXPECT_NEAR(before.rotation_deg, after.rotation_deg, 1e-9);
  EXPECT_NEAR(before.rotation_about_ray_deg, after.rotation_about_ray_deg, 1e-9);
  EXPECT_NEAR(before.direction_deg, after.direction_deg, 1e-9);
}

TEST(CameraError, ACameraWithoutPixelsOrFocalLengthIsAnError) {
  Camera none = true_camera();
  none.K(0, 0) = 0;
  EXPECT_NE(
      test::error_message(ErrorCode::input, [&] { (void)camera_error(none, true_camera(), object_center); }),
      "");
  EXPECT_NE(test::error_message(ErrorCode::input,
                                [&] { (void)camera_error(true_camera(), Camera{}, object_center); }),
            "");
}

TEST(ReprojectionError, OfAMovedPrincipalPointIsTheMove) {
  Camera found = true_camera();
  found.K(0, 2) += 3;
  found.K(1, 2) -= 4;
  const auto points = test::sphere(0.5, 12, object_center).vertices;
  const ReprojectionError error = reprojection_error(points, found, true_camera());
  EXPECT_EQ(error.distance_px.count, points.size());
  EXPECT_NEAR(error.distance_px.mean, 5, 1e-9);
  EXPECT_NEAR(error.distance_px.max, 5, 1e-9);
  EXPECT_EQ(error.behind_found, 0U);
}

TEST(ReprojectionError, IsMeasuredAtTheTrueImageSize) {
  const auto points = test::sphere(0.5, 12, object_center).vertices;
  EXPECT_NEAR(reprojection_error(points, true_camera().resized(320, 240), true_camera()).distance_px.max, 0,
              1e-9);
}

TEST(ReprojectionError, CountsWhatLiesBehind) {
  Camera found = true_camera();
  found.camera_from_world.translation().z() -= 100;
  const auto points = test::sphere(0.5, 6, object_center).vertices;
  const ReprojectionError error = reprojection_error(points, found, true_camera());
  EXPECT_EQ(error.behind_found, points.size());
  EXPECT_EQ(error.distance_px.count, 0U);
  EXPECT_NE(
      test::error_message(ErrorCode::input, [&] { (void)reprojection_error(points, true_camera(), found); }),
      "");
  EXPECT_NE(test::error_message(ErrorCode::input,
                                [&] { (void)reprojection_error({}, true_camera(), true_camera()); }),
            "");
}

}  // namespace
}  // namespace drape::metrics
