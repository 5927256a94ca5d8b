#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "bodies.hpp"
#include "canonical_frame.hpp"
#include "drape/alignment/overlap.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "image_stencil.hpp"
#include "rotation_grid.hpp"
#include "simplified_mesh.hpp"
#include "stencil_moments.hpp"
#include "support.hpp"

namespace drape::alignment {
namespace {

TEST(Moments, OfARectangleAreThoseOfItsPixels) {
  Image8 image(50, 40, 1, stencil::background);
  for (int y = 10; y < 18; ++y)
    for (int x = 20; x < 40; ++x) image.at(x, y) = stencil::object;
  Image8 known(50, 40, 1, 1);
  const Moments moments = moments_of(image, known);
  EXPECT_EQ(moments.pixels, 160);
  EXPECT_DOUBLE_EQ(moments.center.x(), 30);
  EXPECT_DOUBLE_EQ(moments.center.y(), 14);
  EXPECT_NEAR(moments.deviation.x(), std::sqrt((20 * 20 - 1) / 12.0), 1e-12);  // of 20 equal steps
  EXPECT_NEAR(moments.deviation.y(), std::sqrt((8 * 8 - 1) / 12.0), 1e-12);
  for (int y = 0; y < 40; ++y)
    for (int x = 30; x < 50; ++x) known.at(x, y) = 0;
  EXPECT_DOUBLE_EQ(moments_of(image, known).center.x(), 25);
  EXPECT_EQ(moments_of(Image8(5, 5, 1, stencil::background), Image8(5, 5, 1, 1)).pixels, 0);
}

TEST(ImageStencil, IsSampledAtTheNearestPixel) {
  Image8 photo(400, 200, 1, stencil::background);
  for (int y = 100; y < 200; ++y)
    for (int x = 0; x < 200; ++x) photo.at(x, y) = stencil::object;
  photo.at(302, 22) = stencil::unknown;  // in the middle of a block of 4 x 4, where it is sampled
  const ImageStencil image = image_stencil(photo, 100);
  ASSERT_EQ(image.pixels.width(), 100);
  ASSERT_EQ(image.pixels.height(), 50);
  EXPECT_EQ(image.pixels.at(49, 25), stencil::object);
  EXPECT_EQ(image.pixels.at(50, 25), stencil::background);
  EXPECT_EQ(image.pixels.at(49, 24), stencil::background);
  EXPECT_EQ(image.pixels.at(75, 5), stencil::unknown);
  EXPECT_EQ(image.known.at(75, 5), 0);
  EXPECT_EQ(image.box_right, 49);
  EXPECT_EQ(image.box_top, 25);
  EXPECT_EQ(image_stencil(photo, 1000).pixels, photo);  // never enlarged
}

TEST(RotationGrid, Of45DegreesHas208RotationsIn512Cells) {
  const RotationGrid grid = rotation_grid(45);
  EXPECT_EQ(grid.cells.size(), 512U);
  EXPECT_EQ(std::set<std::size_t>(grid.same_rotation.begin(), grid.same_rotation.end()).size(), 208U);
  EXPECT_EQ(std::count(grid.has_earlier_twin.begin(), grid.has_earlier_twin.end(), false), 256);
  for (std::size_t i = 0; i < grid.cells.size(); ++i)
    EXPECT_LT((grid.cells[i].matrix() - grid.cells[grid.same_rotation[i]].matrix()).norm(), 1e-9);
  const RotationGrid fine = rotation_grid(20);
  EXPECT_EQ(fine.cells.size(), 5832U);
  EXPECT_EQ(std::set<std::size_t>(fine.same_rotation.begin(), fine.same_rotation.end()).size(), 2916U);
  EXPECT_EQ(rotation_grid(50).cells.size(), 512U);  // 0, 50 ... 350
}

TEST(RotationGrid, TwinsHaveTheSameNeighbours) {
  const RotationGrid grid = rotation_grid(60);
  for (std::size_t i = 0; i < grid.cells.size(); i += 7) {
    const EulerAngles& a = grid.cells[i];
    const EulerAngles twin{a.pitch_deg + 180, 180 - a.yaw_deg, a.roll_deg + 180};
    const EulerAngles near{a.pitch_deg + 10, a.yaw_deg + 20, a.roll_deg - 30};
    const EulerAngles near_twin{twin.pitch_deg + 10, twin.yaw_deg - 20, twin.roll_deg - 30};
    EXPECT_LT((near.matrix() - near_twin.matrix()).norm(), 1e-12);
  }
}

class Frames : public ::testing::TestWithParam<Camera::Projection> {};

TEST_P(Frames, CameraIsThePoseAsAPinhole) {
  TriangleMesh mesh = knobbed_brick();
  for (Eigen::Vector3d& x : mesh.vertices) x = 250 * x + Eigen::Vector3d(4000, -300, 90);
  const CanonicalFrame frame(mesh, GetParam(), 300, 400);
  ModelPose pose = frame.start(50);
  pose.angles = {20, 30, 40};
  pose.translation << 0.1, -0.2;
  pose.scale << 0.7, 0.8;
  const Camera camera = frame.camera(pose);
  EXPECT_NEAR(camera.camera_from_world.linear().determinant(), 1, 1e-12);
  const BoundingBox box = bounding_box(mesh.vertices);
  const double focal_px = 150 / std::tan(25 * std::numbers::pi / 180);
  for (std::size_t v = 0; v < mesh.vertices.size(); v += 5) {
    // The thesis's order: rotate, scale x and y, translate, project.
    const Eigen::Vector3d canonical = (mesh.vertices[v] - box.center()) / (box.diagonal().maxCoeff() / 2);
    const Eigen::Vector3d turned = pose.angles.matrix() * canonical;
    const Eigen::Vector2d placed = turned.head<2>().cwiseProduct(pose.scale) + pose.translation;
    const Eigen::Vector2d expected =
        Eigen::Vector2d(150, 200) + (GetParam() == Camera::Projection::perspective
                                         ? Eigen::Vector2d(focal_px * placed / (turned.z() + pose.depth))
                                         : Eigen::Vector2d(200 * placed));
    EXPECT_LT((camera.project(mesh.vertices[v]).pixel - expected).norm(), 1e-9);
    EXPECT_GT(camera.project(mesh.vertices[v]).depth, 0);
  }
}

TEST_P(Frames, TranslationMovesTheMiddleByPixels) {
  const TriangleMesh mesh = test::box({-1, -1, -1}, {1, 1, 1});
  const CanonicalFrame frame(mesh, GetParam(), 300, 400);
  ModelPose pose = frame.start(40);
  pose.translation = frame.translation_of({12, -7}, pose);
  EXPECT_LT((frame.camera(pose).project(Eigen::Vector3d::Zero()).pixel - Eigen::Vector2d(162, 193)).norm(),
            1e-9);
  EXPECT_LT((frame.place_at_depth({162, 193}, pose) - pose.translation).norm(), 1e-12);
}

TEST_P(Frames, SizeByDistanceKeepsTheMiddleAndItsScale) {
  const TriangleMesh mesh = test::box({-1, -1, -1}, {1, 1, 1});
  const CanonicalFrame frame(mesh, GetParam(), 300, 300);
  ModelPose pose = frame.start(40);
  pose.translation << 0.2, 0.1;
  pose.scale << 0.5, 0.5;
  const ModelPose moved = frame.scaled_by_distance(pose);
  const auto pixel = [&](const ModelPose& p, double x) {
    return frame.camera(p).project(Eigen::Vector3d(x, 0, 0)).pixel;
  };
  EXPECT_LT((pixel(moved, 0) - pixel(pose, 0)).norm(), 1e-9);
  EXPECT_LT((pixel(moved, 1) - pixel(pose, 1)).norm(), 1e-9);
  if (GetParam() == Camera::Projection::perspective) {
    EXPECT_NEAR(moved.depth, 2 * pose.depth, 1e-9);
    EXPECT_NEAR(moved.scale.x(), 1, 1e-12);
  }
}

TEST(CanonicalFrame, KeepsTheModelInFrontOfAWideCamera) {
  const TriangleMesh mesh = test::box({-1, -1, -1}, {1, 1, 1});
  const CanonicalFrame frame(mesh, Camera::Projection::perspective, 300, 300);
  const Camera camera = frame.camera(frame.start(140));
  for (const Eigen::Vector3d& x : mesh.vertices) EXPECT_GT(camera.project(x).depth, 0.4);
}

INSTANTIATE_TEST_SUITE_P(Projections, Frames,
                         ::testing::Values(Camera::Projection::perspective,
                                           Camera::Projection::orthographic));

TEST(SimplifiedMesh, KeepsTheOutline) {
  const TriangleMesh mesh = test::torus(1, 0.4, 200, 100);
  const TriangleMesh small = simplified_mesh(mesh, 2000);
  EXPECT_LE(small.faces.size(), 2000U);
  EXPECT_LT(small.vertices.size(), 1500U);
  EXPECT_EQ(problem_of(small), "");
  const Camera camera = view_of({30, 20, 10});
  EXPECT_GT(overlap_percent(stencil_of(mesh, camera), stencil_of(small, camera)), 99);
  EXPECT_EQ(simplified_mesh(mesh, 40000).faces, mesh.faces);
}

}  // namespace
}  // namespace drape::alignment
