#include "drape/io/camera_sidecars.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <regex>
#include <sstream>

#include "drape/base/files.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/rendering/renderer.hpp"
#include "support.hpp"

namespace drape {
namespace {

using test::error_message;
using test::ScratchFolder;

// Off the middle, rolled, with two focal lengths.
Camera camera(double aspect = 1.1) {
  Camera c = look_at({3, -2, 1.5}, {0.1, 0, 0}, Eigen::Vector3d(0.2, 0, 1).normalized(), 160, 120, 40);
  c.K(1, 1) *= aspect;
  c.K(0, 2) += 7.25;
  c.K(1, 2) -= 3.5;
  return c;
}

Image8 seen_by(const Camera& c) {
  return rendering::Renderer(test::torus(1, 0.4)).stencil(c);
}

std::vector<double> numbers_in(const std::string& text) {
  std::istringstream stream(text);
  std::vector<double> numbers;
  for (double x = 0; stream >> x;) numbers.push_back(x);
  return numbers;
}

// What stands in quotes after name=, or between <name> and </name>.
std::vector<double> values_of(const std::string& text, const std::string& name) {
  std::smatch found;
  if (std::regex_search(text, found, std::regex(name + "=\"([^\"]*)\"")) ||
      std::regex_search(text, found, std::regex("<" + name + ">([^<]*)</")))
    return numbers_in(found[1]);
  ADD_FAILURE() << "no " << name;
  return std::vector<double>(16, 0.0);
}

TEST(CameraSidecars, ColmapShowsTheSameStencil) {
  const ScratchFolder folder;
  const Camera given = camera();
  io::write_colmap(folder / "colmap", {{"front 1.jpg", given}, {"again.jpg", given}});
  std::istringstream list(read_file(folder / "colmap/cameras.txt"));
  std::istringstream images(read_file(folder / "colmap/images.txt"));
  EXPECT_NO_THROW((void)read_file(folder / "colmap/points3D.txt"));
  std::string line;
  std::vector<std::string> camera_lines;
  while (std::getline(list, line))
    if (line.front() != '#') camera_lines.push_back(line);
  ASSERT_EQ(camera_lines.size(), 1U);  // two photos share it
  std::istringstream fields(camera_lines[0]);
  int id = 0;
  std::string model;
  Camera read;
  fields >> id >> model >> read.width >> read.height >> read.K(0, 0) >> read.K(1, 1) >> read.K(0, 2) >>
      read.K(1, 2);
  EXPECT_EQ(model, "PINHOLE");
  std::vector<std::string> image_lines;
  while (std::getline(images, line))
    if (line.empty() || line.front() != '#') image_lines.push_back(line);
  ASSERT_EQ(image_lines.size(), 4U);
  EXPECT_EQ(image_lines[1], "");
  std::istringstream pose(image_lines[0]);
  int image_id = 0;
  int camera_id = 0;
  Eigen::Quaterniond q;
  Eigen::Vector3d t;
  std::string name;
  pose >> image_id >> q.w() >> q.x() >> q.y() >> q.z() >> t.x() >> t.y() >> t.z() >> camera_id;
  std::getline(pose >> std::ws, name);
  EXPECT_EQ(name, "front 1.jpg");
  EXPECT_EQ(camera_id, id);
  read.camera_from_world = Rigid3::Identity();
  read.camera_from_world.rotate(q).pretranslate(t);
  EXPECT_EQ(seen_by(read), seen_by(given));
}

TEST(CameraSidecars, MeshLabShowsTheSameStencil) {
  const ScratchFolder folder;
  const Camera given = camera(1);
  io::write_meshlab_project(folder / "x.mlp", "model.ply", {{"a&b.jpg", given}});
  const std::string text = read_file(folder / "x.mlp");
  EXPECT_NE(text.find("label=\"a&amp;b.jpg\""), std::string::npos);
  EXPECT_NE(text.find("filename=\"model.ply\""), std::string::npos);
  const std::vector<double> translation = values_of(text, "TranslationVector");
  const std::vector<double> rotation = values_of(text, "RotationMatrix");
  const std::vector<double> viewport = values_of(text, "ViewportPx");
  const std::vector<double> center = values_of(text, "CenterPx");
  ASSERT_EQ(rotation.size(), 16U);
  Camera read;
  read.width = static_cast<int>(viewport[0]);
  read.height = static_cast<int>(viewport[1]);
  read.K << values_of(text, "FocalMm")[0], 0, center[0], 0, values_of(text, "FocalMm")[0], center[1], 0, 0, 1;
  for (int r = 0; r < 3; ++r)  // right, up, backward
    for (int c = 0; c < 3; ++c)
      read.camera_from_world.linear()(r, c) =
          (r == 0 ? 1 : -1) * rotation[static_cast<std::size_t>(4 * r + c)];
  const Eigen::Vector3d eye = -Eigen::Vector3d(translation[0], translation[1], translation[2]);
  read.camera_from_world.translation() = -(read.camera_from_world.linear() * eye);
  EXPECT_EQ(seen_by(read), seen_by(given));
}

TEST(CameraSidecars, MetashapeShowsTheSameStencil) {
  const ScratchFolder folder;
  Camera given = camera();
  given.K(0, 1) = 4;
  io::write_metashape_xml(folder / "x.xml", {{"a.jpg", given}});
  const std::string text = read_file(folder / "x.xml");
  const std::vector<double> transform = values_of(text, "transform");
  const auto value = [&](const char* name) { return values_of(text, name)[0]; };
  ASSERT_EQ(transform.size(), 16U);
  Camera read;
  read.width = static_cast<int>(value("width"));
  read.height = static_cast<int>(value("height"));
  read.K << value("f") + value("b1"), value("b2"), read.width / 2.0 + value("cx"), 0, value("f"),
      read.height / 2.0 + value("cy"), 0, 0, 1;
  Rigid3 world_from_camera = Rigid3::Identity();
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c)
      world_from_camera.matrix()(r, c) = transform[static_cast<std::size_t>(4 * r + c)];
  read.camera_from_world = world_from_camera.inverse();
  EXPECT_EQ(seen_by(read), seen_by(given));
}

TEST(CameraSidecars, WhatAFormatCannotHoldIsRefusedWithTheReason) {
  const ScratchFolder folder;
  Camera orthographic = camera();
  orthographic.projection = Camera::Projection::orthographic;
  for (const auto format :
       {io::SidecarFormat::colmap, io::SidecarFormat::meshlab, io::SidecarFormat::metashape})
    EXPECT_NE(io::reason_not_held(format, orthographic).find("orthographic"), std::string::npos);
  const std::string message = error_message(ErrorCode::input, [&] {
    io::write_metashape_xml(folder / "x.xml", {{"a.jpg", orthographic}});
  });
  EXPECT_NE(message.find("x.xml: the camera of a.jpg is orthographic"), std::string::npos) << message;
  EXPECT_FALSE(std::filesystem::exists(folder / "x.xml"));
  EXPECT_NE(io::reason_not_held(io::SidecarFormat::meshlab, camera(1.1)).find("focal"), std::string::npos);
  EXPECT_EQ(io::reason_not_held(io::SidecarFormat::colmap, camera(1.1)), "");
  Camera sheared = camera();
  sheared.K(0, 1) = 5;
  EXPECT_NE(io::reason_not_held(io::SidecarFormat::colmap, sheared).find("shear"), std::string::npos);
}

TEST(Stl, ReadsBackAsTheSameSurface) {
  const ScratchFolder folder;
  const TriangleMesh torus = test::torus(1, 0.4, 16, 8);
  io::write_stl(folder / "x.stl", torus);
  const TriangleMesh read = io::read_mesh(folder / "x.stl");
  EXPECT_EQ(read.vertices.size(), torus.vertices.size());
  ASSERT_EQ(read.faces.size(), torus.faces.size());
  EXPECT_NEAR(signed_volume(read), signed_volume(torus), 1e-5);
  TriangleMesh broken = torus;
  broken.faces[0][0] = 99999;
  EXPECT_NE(error_message(ErrorCode::input, [&] { io::write_stl(folder / "y.stl", broken); }), "");
}

}  // namespace
}  // namespace drape
