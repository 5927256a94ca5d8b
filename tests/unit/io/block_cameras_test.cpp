#include "drape/io/block_cameras.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "drape/base/files.hpp"
#include "drape/io/camera_sidecars.hpp"
#include "support.hpp"

namespace drape::io {
namespace {

using test::error_message;
using test::ScratchFolder;

Camera camera(double x) {
  Camera c = look_at({x, -2, 1.5}, {0.1, 0, 0}, Eigen::Vector3d(0.2, 0, 1).normalized(), 160, 120, 40);
  c.K(1, 1) *= 1.1;
  c.K(0, 2) += 7.25;
  c.K(1, 2) -= 3.5;
  return c;
}

void expect_same(const BlockCamera& read, const Camera& written) {
  EXPECT_EQ(read.width, written.width);
  EXPECT_EQ(read.height, written.height);
  EXPECT_LT((read.K_at(160, 120) - written.K).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((read.camera_from_block.matrix() - written.camera_from_world.matrix()).cwiseAbs().maxCoeff(),
            1e-9);
  EXPECT_TRUE(read.distortion.empty());
}

TEST(BlockCameras, ColmapsTextModelComesBack) {
  const ScratchFolder folder;
  write_colmap(folder / "sparse", {{"shots/front 1.jpg", camera(3)}, {"back.jpg", camera(-3)}});
  const auto cameras = read_block_cameras(folder / "sparse/images.txt");
  ASSERT_EQ(cameras.size(), 2U);
  ASSERT_NE(find_camera(cameras, "front 1.jpg"), nullptr);
  expect_same(*find_camera(cameras, "front 1.jpg"), camera(3));
  expect_same(*find_camera(cameras, "back.jpg"), camera(-3));
  EXPECT_EQ(find_camera(cameras, "side.jpg"), nullptr);
}

TEST(BlockCameras, MetashapesXmlComesBack) {
  const ScratchFolder folder;
  Camera sheared = camera(-3);
  sheared.K(0, 1) = 0.5;
  write_metashape_xml(folder / "cameras.xml", {{"front", camera(3)}, {"back", sheared}});
  const auto cameras = read_block_cameras(folder / "cameras.xml");
  ASSERT_EQ(cameras.size(), 2U);
  // Metashape's labels may lack the file's ending.
  ASSERT_NE(find_camera(cameras, "front.jpg"), nullptr);
  expect_same(*find_camera(cameras, "front.jpg"), camera(3));
  expect_same(*find_camera(cameras, "back.jpg"), sheared);
}

TEST(BlockCameras, BundlersAxesAreTurned) {
  const ScratchFolder folder;
  // At (0, 0, 5), looking along -z: an OpenCV camera's x is to the right, its y and z are turned round.
  write_file(folder / "bundle.out",
             "# Bundle file v0.3\n2 0\n500 -0.1 0.02\n1 0 0\n0 1 0\n0 0 1\n0 0 -5\n"
             "0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n");
  write_file(folder / "list.txt", "./a.jpg 0 500\n./b.jpg\n");
  const auto cameras = read_block_cameras(folder / "bundle.out");
  ASSERT_EQ(cameras.size(), 1U) << "b.jpg was not placed";
  const BlockCamera& a = cameras[0];
  EXPECT_EQ(find_camera(cameras, "a.jpg"), &a);
  // (1, 1, 0) is to the right of and above the middle, five units away.
  const Eigen::Vector3d seen = a.camera_from_block * Eigen::Vector3d(1, 1, 0);
  EXPECT_LT((seen - Eigen::Vector3d(1, -1, 5)).norm(), 1e-12);
  const Eigen::Matrix3d K = a.K_at(640, 480);
  EXPECT_LT(((K * seen).hnormalized() - Eigen::Vector2d(420, 140)).norm(), 1e-9);
  EXPECT_EQ(a.distortion, (std::vector<double>{-0.1, 0.02, 0, 0}));
}

TEST(BlockCameras, DistortionIsOpenCvs) {
  const ScratchFolder folder;
  write_file(folder / "cameras.txt",
             "# a comment\n1 OPENCV 640 480 500 510 320 240 0.1 0.2 0.3 0.4\n2 SIMPLE_RADIAL 640 480 500 320 "
             "240 0.1\n");
  write_file(folder / "images.txt", "1 1 0 0 0 0 0 5 1 a.jpg\n\n2 1 0 0 0 0 0 6 2 b.jpg\n1.5 2.5 -1");
  auto cameras = read_block_cameras(folder / "images.txt");
  ASSERT_EQ(cameras.size(), 2U);
  EXPECT_EQ(cameras[0].distortion, (std::vector<double>{0.1, 0.2, 0.3, 0.4}));
  EXPECT_EQ(cameras[1].distortion, (std::vector<double>{0.1, 0, 0, 0}));
  // A photo of half the size.
  EXPECT_EQ(cameras[0].K_at(320, 240)(1, 1), 255);
  write_file(
      folder / "m.xml",
      "<document><chunk><sensors><sensor id=\"0\"><calibration type=\"frame\"><resolution width=\"100\" "
      "height=\"80\"/><f>90</f><k1>0.1</k1><k2>0.2</k2><k3>0.3</k3><p1>0.4</p1><p2>0.5</p2></calibration>"
      "</sensor></sensors><cameras><group><camera sensor_id=\"0\" label=\"a\"><transform>1 0 0 0 0 1 0 0 0 0 "
      "1 0 0 0 0 1</transform></camera></group><camera sensor_id=\"0\" "
      "label=\"b\"/></cameras></chunk></document>");
  cameras = read_block_cameras(folder / "m.xml");
  ASSERT_EQ(cameras.size(), 1U);
  EXPECT_EQ(cameras[0].distortion, (std::vector<double>{0.1, 0.2, 0.5, 0.4, 0.3}));
}

TEST(BlockCameras, WhatIsWrongIsNamed) {
  const ScratchFolder folder;
  const auto message = [&](const char* file) {
    return error_message(ErrorCode::input, [&] { (void)read_block_cameras(folder / file); });
  };
  const auto says = [&](const char* file, const char* what) {
    EXPECT_NE(message(file).find(what), std::string::npos) << message(file);
  };
  write_file(folder / "images.txt", "1 1 0 0 0 0 0 x 1 a.jpg\n\n");
  says("images.txt", "cameras.txt");
  write_file(folder / "cameras.txt", "1 FISHEYE 640 480 500\n");
  says("images.txt", "FISHEYE");
  write_file(folder / "cameras.txt", "1 PINHOLE 640 480 500\n");
  says("images.txt", "4 parameters");
  write_file(folder / "cameras.txt", "1 SIMPLE_PINHOLE 640 480 500 320 240\n");
  says("images.txt", "images.txt:1: \"x\" is no number");
  write_file(folder / "images.txt", "1 1 0 0 0 0 0 5 7 a.jpg\n\n");
  says("images.txt", "not in cameras.txt");
  write_file(folder / "images.txt", "# nothing\n");
  says("images.txt", "holds no camera");
  write_file(folder / "bundle.out", "1 0\n500 0 0\n1 0 0\n");
  write_file(folder / "list.txt", "a.jpg\n");
  says("bundle.out", "ends before");
  write_file(folder / "list.txt", "a.jpg\nb.jpg\n");
  says("bundle.out", "2 photos");
  write_file(folder / "broken.xml", "<document><chunk>");
  says("broken.xml", "damaged");
  write_file(folder / "empty.xml", "<document/>");
  says("empty.xml", "holds no camera");
  says("cameras.nvm", "no file of cameras");
}

}  // namespace
}  // namespace drape::io
