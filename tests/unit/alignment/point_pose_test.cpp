#include "drape/alignment/point_pose.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "drape/base/error.hpp"

namespace drape::alignment {
namespace {

constexpr int width = 1200;
constexpr int height = 900;

std::vector<Eigen::Vector3d> corners() {
  return {{0.1, 0.2, 0.0},    {-0.15, 0.1, 0.05}, {0.05, -0.2, 0.12},
          {-0.1, -0.1, -0.2}, {0.2, 0.0, 0.15},   {0.0, 0.15, -0.1}};
}

std::vector<PointPair> seen_by(const Camera& camera, const std::vector<Eigen::Vector3d>& points) {
  std::vector<PointPair> pairs;
  for (const Eigen::Vector3d& x : points) pairs.push_back({camera.project(x).pixel, x});
  return pairs;
}

double direction_error_deg(const Camera& a, const Camera& b) {
  const Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  return std::acos(std::min(1.0, a.towards_camera(middle).dot(b.towards_camera(middle)))) * 180 /
         std::numbers::pi;
}

TEST(PointPose, ExactPairsGiveTheCameraFromAnySide) {
  for (int i = 0; i < 12; ++i) {
    const double azimuth = 0.55 * i;
    const double z = -0.9 + 1.8 * i / 11;
    const Eigen::Vector3d eye = 1.5 * Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), z).normalized();
    const Camera truth =
        look_at(eye, Eigen::Vector3d(0.02, 0, 0), Eigen::Vector3d::UnitZ(), width, height, 35);
    const PointPose found = camera_from_points(seen_by(truth, corners()), width, height, truth.K(0, 0));
    EXPECT_LT(found.rms_px, 1e-3) << i;
    EXPECT_LT((found.camera.center() - eye).norm(), 1e-4) << i;
  }
}

TEST(PointPose, FindsTheFocalLengthToo) {
  const Camera truth = look_at({0.5, -0.6, 0.3}, {0, 0, 0}, Eigen::Vector3d::UnitZ(), width, height, 70);
  const PointPose found = camera_from_points(seen_by(truth, corners()), width, height);
  EXPECT_LT(found.rms_px, 2);
  EXPECT_NEAR(found.camera.K(0, 0) / truth.K(0, 0), 1, 0.03);
  EXPECT_LT(direction_error_deg(found.camera, truth), 1);
}

TEST(PointPose, CoarseClicksOnFourPlanarPointsAreNearEnoughToStartFrom) {
  const std::vector<Eigen::Vector3d> square = {
      {0.2, 0.2, 0}, {-0.2, 0.2, 0}, {-0.2, -0.2, 0}, {0.2, -0.1, 0}};
  const Camera truth = look_at({0.8, -1.2, 1.1}, {0, 0, 0}, Eigen::Vector3d::UnitZ(), width, height, 40);
  std::mt19937 random(5);
  std::normal_distribution<double> click(0, 3);
  for (int i = 0; i < 10; ++i) {
    std::vector<PointPair> pairs = seen_by(truth, square);
    for (PointPair& pair : pairs) pair.pixel += Eigen::Vector2d(click(random), click(random));
    const PointPose found = camera_from_points(pairs, width, height);
    EXPECT_LT(direction_error_deg(found.camera, truth), 20) << i;
  }
}

TEST(PointPose, WhateverUnitAndPlaceTheMeshHas) {
  const Camera truth = look_at({1, 1, 0.4}, {0, 0, 0}, Eigen::Vector3d::UnitZ(), width, height, 30);
  std::vector<PointPair> pairs = seen_by(truth, corners());
  const Eigen::Vector3d place(4e3, -7e2, 55);
  for (PointPair& pair : pairs) pair.point = 1000 * pair.point + place;
  const PointPose found = camera_from_points(pairs, width, height, truth.K(0, 0));
  EXPECT_LT(found.rms_px, 1e-3);
  EXPECT_LT((found.camera.center() - (1000 * truth.center() + place)).norm(), 0.1);
}

TEST(PointPose, TooFewPairsOrPairsOnALineAreRefused) {
  const Camera truth = look_at({1, 1, 0.4}, {0, 0, 0}, Eigen::Vector3d::UnitZ(), width, height, 30);
  std::vector<PointPair> pairs = seen_by(truth, corners());
  const std::vector<PointPair> three(pairs.begin(), pairs.begin() + 3);
  EXPECT_THROW(static_cast<void>(camera_from_points(three, width, height)), Error);
  for (std::size_t i = 0; i < pairs.size(); ++i)
    pairs[i].point = static_cast<double>(i) * Eigen::Vector3d(1, 2, 3);
  EXPECT_THROW(static_cast<void>(camera_from_points(pairs, width, height)), Error);
}

}  // namespace
}  // namespace drape::alignment
