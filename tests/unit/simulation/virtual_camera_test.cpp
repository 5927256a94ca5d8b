#include "drape/simulation/virtual_camera.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "drape/base/parallel.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/rendering/renderer.hpp"
#include "support.hpp"

namespace drape::simulation {
namespace {

using Eigen::Vector3d;

const Subject& teapot() {
  static const Subject subject = make_subject({ObjectKind::teapot, 1, 2.5});
  return subject;
}

/// Pixels in which two stencils differ, other than beside a pixel of the other kind in `reference`.
int differences_off_the_rim(const Image8& stencil, const Image8& reference) {
  int count = 0;
  for (int y = 0; y < stencil.height(); ++y)
    for (int x = 0; x < stencil.width(); ++x) {
      if (stencil.at(x, y) == reference.at(x, y)) continue;
      bool rim = false;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          rim = rim ||
                (reference.contains(x + dx, y + dy) && reference.at(x + dx, y + dy) != reference.at(x, y));
      if (!rim) ++count;
    }
  return count;
}

int object_pixels(const Image8& stencil) {
  return static_cast<int>(std::count(stencil.data().begin(), stencil.data().end(), stencil::object));
}

TEST(VirtualCamera, TheStencilIsWhatOpenGlDraws) {
  for (const auto projection : {Camera::Projection::perspective, Camera::Projection::orthographic}) {
    Camera camera = camera_round(teapot().mesh, 200, 150, 35, -60, 25, 3, 110, {0.05, -0.03});
    if (projection == Camera::Projection::orthographic) {
      camera.projection = projection;
      camera.K.diagonal().head<2>().setConstant(700);
    }
    const SimulatedPhoto photo = take_photo(teapot(), camera, {Table::wood, true, 1, 1});
    const Image8 drawn = rendering::Renderer(teapot().mesh).stencil(camera);
    EXPECT_GT(object_pixels(drawn), 3000);
    EXPECT_EQ(differences_off_the_rim(photo.stencil, drawn), 0);
    // Within the rim the two may only differ where a centre lies on the outline to rounding errors.
    int different = 0;
    for (std::size_t i = 0; i < drawn.data().size(); ++i)
      different += drawn.data()[i] != photo.stencil.data()[i];
    EXPECT_LT(different, 12);
  }
}

TEST(VirtualCamera, StencilOfASphereIsADisc) {
  Subject subject;
  subject.mesh = test::sphere(0.1, 60);
  const Camera camera = camera_round(subject.mesh, 161, 121, 40, 0, 0);
  const SimulatedPhoto photo = take_photo(subject, camera, {Table::cloth, false, 0, 1});
  // A sphere at distance d shows as a disc of radius f * r / sqrt(d^2 - r^2).
  const double d = camera.center().norm();
  const double disc = camera.K(0, 0) * 0.1 / std::sqrt(d * d - 0.01);
  for (int y = 0; y < 121; ++y)
    for (int x = 0; x < 161; ++x) {
      const double off = std::hypot(x + 0.5 - 80.5, y + 0.5 - 60.5);
      if (off > disc - 0.15 && off < disc + 0.01) continue;
      EXPECT_EQ(photo.stencil.at(x, y), off < disc ? stencil::object : stencil::background) << x << " " << y;
    }
}

TEST(VirtualCamera, CameraRoundStandsWhereItIsTold) {
  const TriangleMesh mesh = test::box({-1, -1, 0}, {1, 1, 2});
  const Vector3d middle(0, 0, 1);
  const Camera front = camera_round(mesh, 400, 300, 40, -90, 0);
  EXPECT_LT((front.center() - middle).normalized().cross(-Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((front.project(middle).pixel - Eigen::Vector2d(200, 150)).norm(), 1e-9);
  EXPECT_LT(front.project({0, 0, 2}).pixel.y(), 150);
  EXPECT_GT(front.project({1, 0, 1}).pixel.x(), 200);
  // The bounding sphere's outline at 90 % of the height.
  const double d = (front.center() - middle).norm();
  EXPECT_NEAR(front.K(0, 0) * std::sqrt(3.0) / std::sqrt(d * d - 3), 0.9 * 150, 1e-9);
  const Camera above = camera_round(mesh, 400, 300, 40, 0, 90);
  EXPECT_LT((above.center() - middle).normalized().cross(Vector3d::UnitZ()).norm(), 1e-12);
  const Camera beside = camera_round(mesh, 400, 300, 40, -90, 0, 0, 90, {0.1, -0.2});
  EXPECT_LT((beside.center() - front.center()).norm(), 1e-12);
  EXPECT_NEAR(beside.project(middle).pixel.x(), 200 + 40, 2);
  EXPECT_NEAR(beside.project(middle).pixel.y(), 150 - 60, 2);
}

TEST(VirtualCamera, TheSubjectStandsOutInColour) {
  const Camera camera = camera_round(teapot().mesh, 160, 120, 35, -60, 25);
  const SimulatedPhoto photo = take_photo(teapot(), camera, {Table::wood, true, 1, 1});
  // Blue on warm colours: told by blue against red alone, all but a few pixels are on the right side.
  int wrong = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) {
      const bool blue = photo.image.at(x, y, 2) > photo.image.at(x, y, 0);
      wrong += blue != (photo.stencil.at(x, y) == stencil::object);
    }
  EXPECT_LT(wrong, object_pixels(photo.stencil) * 4 / 100);
}

TEST(VirtualCamera, PaintIsSharpWhateverTheMesh) {
  // Two subjects of one shape and paint, one with a coarse mesh: the paint's pattern is the same.
  const auto stripes = [](const Vector3d& p) {
    return std::fmod(std::abs(p.x()) * 100, 1.0) < 0.5 ? Eigen::Vector3f(1, 1, 1) : Eigen::Vector3f(0, 0, 0);
  };
  Subject subject;
  subject.mesh = test::box({-0.1, -0.1, 0}, {0.1, 0.1, 0.1});
  subject.color = stripes;
  subject.normal = [](const Vector3d&) { return Vector3d(0, 0, 1); };
  const Camera camera = camera_round(subject.mesh, 240, 180, 30, -90, 90);
  const SimulatedPhoto photo = take_photo(subject, camera, {Table::wood, false, 0, 1});
  int checked = 0;
  for (int x = 60; x < 180; ++x) {
    // The pixel's extent on the top, z = 0.1.
    const double depth = camera.project({0, 0, 0.1}).depth;
    const double left = camera.unproject({static_cast<double>(x), 90.5}, depth).x();
    const double right = camera.unproject({x + 1.0, 90.5}, depth).x();
    if (stripes({left, 0, 0}) != stripes({right, 0, 0})) continue;
    ++checked;
    EXPECT_EQ(photo.image.at(x, 90, 0) > 100, stripes({left, 0, 0}).x() > 0.5F) << x;
  }
  EXPECT_GT(checked, 60);
}

TEST(VirtualCamera, NoiseIsAsLargeAsAskedAndSeeded) {
  const Camera camera = camera_round(teapot().mesh, 120, 90, 35, -60, 25);
  const PhotoStyle clean{Table::wood, false, 0, 1};
  const PhotoStyle noisy{Table::wood, false, 2, 1};
  const SimulatedPhoto without = take_photo(teapot(), camera, clean);
  const SimulatedPhoto with = take_photo(teapot(), camera, noisy);
  EXPECT_EQ(without.stencil, with.stencil);
  const auto linear = [](std::uint8_t v) { return std::pow((v / 255.0 + 0.055) / 1.055, 2.4); };
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < with.image.data().size(); ++i) {
    const double level = linear(without.image.data()[i]);
    if (level < 0.1 || level > 0.8) continue;
    sum += std::pow(linear(with.image.data()[i]) - level, 2) / level;
    ++count;
  }
  ASSERT_GT(count, 2000);
  EXPECT_NEAR(std::sqrt(sum / count), 0.02, 0.002);
  PhotoStyle other = noisy;
  other.seed = 2;
  EXPECT_NE(take_photo(teapot(), camera, other).image, with.image);
}

TEST(VirtualCamera, TheSameForAnyNumberOfThreads) {
  const Camera camera = camera_round(teapot().mesh, 120, 90, 35, 100, 40);
  set_thread_count(1);
  const SimulatedPhoto one = take_photo(teapot(), camera, {});
  set_thread_count(4);
  const SimulatedPhoto four = take_photo(teapot(), camera, {});
  set_thread_count(0);
  EXPECT_EQ(one.image, four.image);
  EXPECT_EQ(one.stencil, four.stencil);
}

}  // namespace
}  // namespace drape::simulation
