#include "drape/metrics/normal_deviation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "drape/base/parallel.hpp"
#include "support.hpp"

namespace drape::metrics {
namespace {

TriangleMesh square(double tilt_deg) {
  const Eigen::AngleAxisd tilt(tilt_deg * std::numbers::pi / 180, Eigen::Vector3d::UnitX());
  TriangleMesh mesh;
  for (const Eigen::Vector3d& corner : {Eigen::Vector3d(-1, -1, 0), Eigen::Vector3d(1, -1, 0),
                                        Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(-1, 1, 0)})
    mesh.vertices.emplace_back(tilt * corner);
  mesh.faces = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

TEST(NormalDeviation, OfATiltedSquareIsItsTilt) {
  for (const double tilt_deg : {0.0, 0.001, 12.0, 60.0}) {
    const NormalDeviation d = normal_deviation(square(tilt_deg), square(0), 500);
    EXPECT_NEAR(d.angle_deg.mean, tilt_deg, 1e-9);
    EXPECT_NEAR(d.angle_deg.max, tilt_deg, 1e-9);
    EXPECT_EQ(d.flipped_percent, 0);
  }
}

TEST(NormalDeviation, CountsFacesThatLookTheOtherWay) {
  TriangleMesh flipped = test::sphere(1, 24);
  double flipped_area = 0;
  for (std::size_t i = 0; i < flipped.faces.size(); ++i)
    if (flipped.vertices[flipped.faces[i][0]].z() < 0) {
      std::swap(flipped.faces[i][1], flipped.faces[i][2]);
      flipped_area += scaled_face_normal(flipped, i).norm() / 2;
    }
  const NormalDeviation d = normal_deviation(flipped, test::sphere(1, 24), 4000);
  EXPECT_NEAR(d.flipped_percent, 100 * flipped_area / surface_area(flipped), 0.5);
  EXPECT_NEAR(d.angle_deg.max, 180, 1e-6);
}

TEST(NormalDeviation, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh a = test::sphere(1, 20);
  const TriangleMesh b = test::torus(0.9, 0.4);
  set_thread_count(1);
  const NormalDeviation one = normal_deviation(a, b, 5000);
  set_thread_count(4);
  const NormalDeviation four = normal_deviation(a, b, 5000);
  set_thread_count(0);
  EXPECT_EQ(one.angle_deg.mean, four.angle_deg.mean);
  EXPECT_EQ(one.flipped_percent, four.flipped_percent);
}

TEST(NormalDeviation, WithoutSamplesOrAreaIsAnError) {
  const TriangleMesh box = test::box({0, 0, 0}, {1, 1, 1});
  EXPECT_NE(test::error_message(ErrorCode::input, [&] { (void)normal_deviation(box, box, 0); }), "");
  EXPECT_NE(test::error_message(ErrorCode::input, [&] { (void)normal_deviation(TriangleMesh{}, box); }), "");
  EXPECT_NE(test::error_message(ErrorCode::input, [&] { (void)normal_deviation(box, TriangleMesh{}); }), "");
}

}  // namespace
}  // namespace drape::metrics
