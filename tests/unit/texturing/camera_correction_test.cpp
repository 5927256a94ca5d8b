// Cameras that are a little off, corrected by outlines and by the photos' agreement; and texels along seams.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "drape/base/random.hpp"
#include "outline_pose.hpp"
#include "painted_object.hpp"
#include "photo_agreement.hpp"
#include "seam_texels.hpp"
#include "support.hpp"

namespace drape::texturing {
namespace {

// Three different half axes and a bulge: its outline tells how it is turned.
TriangleMesh bulging() {
  TriangleMesh mesh = test::sphere(1, 32);
  for (Eigen::Vector3d& x : mesh.vertices) {
    const double bulge = 1 + 0.35 * std::exp(-6 * (x - Eigen::Vector3d(0.5, 0.3, 0.8)).squaredNorm());
    x = bulge * Eigen::Vector3d(1.1 * x.x(), 0.7 * x.y(), 0.9 * x.z());
  }
  return mesh;
}

Camera camera_at(const Eigen::Vector3d& eye) {
  return look_at(eye, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), 320, 240, 40);
}

Camera turned(const Camera& camera, const Eigen::Vector3d& axis, double degrees, double zoom) {
  Camera off = camera;
  off.K.topLeftCorner<2, 2>() *= zoom;
  const Eigen::Vector3d middle = camera.camera_from_world.translation();
  const Eigen::AngleAxisd turn(degrees * std::numbers::pi / 180, axis.normalized());
  off.camera_from_world = Eigen::Translation3d(middle.x(), middle.y(), zoom * middle.z()) * turn *
                          Eigen::Translation3d(-middle) * camera.camera_from_world;
  return off;
}

// Root mean square shift in the photo of the vertices in front.
double shift_px(const TriangleMesh& mesh, const Camera& a, const Camera& b) {
  double sum = 0;
  double count = 0;
  for (const Eigen::Vector3d& x : mesh.vertices) {
    if (x.dot(a.towards_camera(Eigen::Vector3d::Zero())) < 0) continue;
    sum += (a.project(x).pixel - b.project(x).pixel).squaredNorm();
    count += 1;
  }
  return std::sqrt(sum / count);
}

TEST(OutlinePose, FindsTheCameraThatTheStencilWasDrawnBy) {
  const TriangleMesh mesh = bulging();
  const Camera camera = camera_at({4, -2, 1.5});
  const Camera off = turned(camera, {0.4, 0.3, 1}, 1.2, 1.01);
  rendering::Renderer renderer(mesh);
  const Image8 stencil = renderer.stencil(camera);
  const OutlinePose found = pose_on_outline(mesh, off, stencil, Eigen::Vector3d::Zero(), 12);
  EXPECT_GT(shift_px(mesh, camera, off), 1);
  EXPECT_LT(shift_px(mesh, camera, found.camera), 0.35);
  EXPECT_GT(found.moved_px, 0.5);
  // Bounded, switched off, and quiet where nothing is wrong.
  EXPECT_EQ(pose_on_outline(mesh, off, stencil, Eigen::Vector3d::Zero(), 0.5).moved_px, 0);
  EXPECT_EQ(pose_on_outline(mesh, off, stencil, Eigen::Vector3d::Zero(), 0).moved_px, 0);
  EXPECT_EQ(pose_on_outline(mesh, camera, stencil, Eigen::Vector3d::Zero(), 12).moved_px, 0);
  EXPECT_EQ(pose_on_outline(mesh, off, {}, Eigen::Vector3d::Zero(), 12).moved_px, 0);
}

// A sphere's outline does not tell how it is turned; its paint does.
TEST(PhotoAgreement, TurnsACameraThatTheOutlineDoesNotHold) {
  const TriangleMesh sphere = test::sphere(1, 48);
  const Paint paint = waves(0.5);
  const std::vector<Camera> cameras = {camera_at({4, 0, 0.5}), camera_at({3.3, 2.2, 0.2}),
                                       camera_at({2.4, 3.2, 0.6})};
  std::vector<Shot> shots;
  for (const Camera& camera : cameras) shots.push_back(photographed(sphere, camera, paint));
  const Camera off = turned(cameras[1], {0.2, 1, 0.3}, 1.5, 1);
  rendering::Renderer renderer(sphere);
  const auto agreed = [&](double most_px, bool alone) {
    std::vector<ImageF> depths;
    std::vector<AgreementView> views;
    for (std::size_t i = 0; i < cameras.size(); ++i)
      depths.push_back(renderer.depth_map(i == 1 ? off : cameras[i]).depth);
    for (std::size_t i = 0; i < cameras.size(); ++i)
      if (!alone || i == 1)
        views.push_back({shots[i].photo, shots[i].stencil, i == 1 ? off : cameras[i], depths[i],
                         // The others are known.
                         (i == 1 ? 0.0 : 1e9) * PoseMatrix::Identity()});
    return agreeing_cameras(sphere, views, most_px);
  };
  const AgreeingCameras found = agreed(12, false);
  EXPECT_GT(shift_px(sphere, cameras[1], off), 1.5);
  EXPECT_LT(shift_px(sphere, cameras[1], found.cameras[1]), 0.4);
  EXPECT_LT(shift_px(sphere, cameras[0], found.cameras[0]), 0.2);
  EXPECT_GT(found.moved_px[1], 1);
  EXPECT_EQ(agreed(0, false).cameras[1].P(), off.P());
  EXPECT_EQ(agreed(1, false).cameras[1].P(), off.P());
  EXPECT_EQ(agreed(12, true).cameras[0].P(), off.P());
}

TEST(PoseMaxPx, IsReportedAndCanBeSwitchedOff) {
  const TriangleMesh mesh = bulging();
  const Camera camera = camera_at({4, -2, 1.5});
  const Shot shot = photographed(mesh, camera, waves(0.5));
  const TextureView view{shot.photo, turned(camera, {0.4, 0.3, 1}, 1.2, 1.01), shot.stencil, "photo"};
  TextureOptions options;
  const ViewUse corrected = texture_mesh(mesh, mesh, std::vector<TextureView>{view}, options).views[0];
  EXPECT_GT(corrected.pose_px, 0.5);
  EXPECT_LT(shift_px(mesh, camera, corrected.camera), 0.35);
  options.pose_max_px = 0;
  const ViewUse kept = texture_mesh(mesh, mesh, std::vector<TextureView>{view}, options).views[0];
  EXPECT_EQ(kept.pose_px, 0);
  EXPECT_EQ(kept.camera.P(), view.camera.P());
}

TEST(SeamTexels, ShowTheSameOnBothSides) {
  std::array<Image8, 2> pages = {Image8(40, 40, 3), Image8(40, 40, 3)};
  Rng rng(3);
  for (Image8& page : pages)
    for (std::uint8_t& value : page.data()) value = static_cast<std::uint8_t>(120 + rng.below(17));
  const std::vector<Seam> seams = {{{{{0, {5.3, 6.1}, {30.2, 11.7}}, {1, {8.8, 30.4}, {29.1, 14.2}}}}},
                                   {{{{0, {20.5, 30.5}, {35.5, 30.5}}, {0, {5.5, 20.1}, {5.1, 35.3}}}}}};
  const auto largest_step = [&] {
    double most = 0;
    for (const Seam& seam : seams)
      for (int i = 0; i <= 60; ++i) {
        std::array<Eigen::Vector3d, 2> colors;
        for (std::size_t s = 0; s < 2; ++s) {
          const Seam::Side& side = seam.sides[s];
          colors[s] = sampled(pages[side.page], (side.from + i / 60.0 * (side.to - side.from)) / 40);
        }
        most = std::max(most, (colors[0] - colors[1]).cwiseAbs().maxCoeff());
      }
    return most;
  };
  const std::array<Image8, 2> before = pages;
  EXPECT_GT(largest_step(), 6);
  const std::array<Image8*, 2> both = {&pages[0], &pages[1]};
  match_texels_along<std::uint8_t>(seams, both);
  EXPECT_LT(largest_step(), 3);
  EXPECT_EQ(pages[0].at(35, 2), before[0].at(35, 2));  // away from the seams
  EXPECT_EQ(pages[1].at(2, 2), before[1].at(2, 2));
}

}  // namespace
}  // namespace drape::texturing
