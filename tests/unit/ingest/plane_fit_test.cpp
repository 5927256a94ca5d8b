#include "plane_fit.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "drape/base/random.hpp"

namespace drape::ingest {
namespace {

Eigen::Vector3d random_point(Rng& rng) {
  return {rng.normal(), rng.normal(), rng.normal()};
}

TEST(PlaneFitTest, IsTheLeastAxisOfTheCovariance) {
  Rng rng(1);
  for (const double thickness : {0.0, 1e-6, 0.01, 0.5}) {
    const Eigen::Matrix3d turn =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), random_point(rng)).toRotationMatrix();
    PlaneFit plane;
    std::vector<Eigen::Vector3d> points;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (int i = 0; i < 30; ++i) {
      const Eigen::Vector3d p = random_point(rng);
      points.emplace_back(Eigen::Vector3d(0.2, 0.1, -0.3) +
                          turn * Eigen::Vector3d(2 * p.x(), p.y(), thickness * p.z()));
      plane.add(points.back());
      mean += points.back() / 30;
    }
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    for (const auto& p : points) covariance += (p - mean) * (p - mean).transpose();
    const Eigen::Vector3d expected =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors().col(0);
    EXPECT_NEAR(std::abs(plane.normal().cast<double>().dot(expected)), 1, 1e-6) << thickness;
  }
}

TEST(PlaneFitTest, ALineGivesADirectionAcrossIt) {
  PlaneFit plane;
  const Eigen::Vector3d along = Eigen::Vector3d(1, 2, -3).normalized();
  for (int i = 0; i < 9; ++i) plane.add(i * along);
  EXPECT_NEAR(static_cast<double>(plane.normal().norm()), 1, 1e-6);
  EXPECT_NEAR(plane.normal().cast<double>().dot(along), 0, 1e-5);
}

TEST(PlaneFitTest, APointGivesSomeDirection) {
  PlaneFit plane;
  EXPECT_NEAR(static_cast<double>(plane.normal().norm()), 1, 1e-6);
  plane.add(Eigen::Vector3d::Ones());
  EXPECT_NEAR(static_cast<double>(plane.normal().norm()), 1, 1e-6);
}

}  // namespace
}  // namespace drape::ingest
