#include "drape/report/turntable.hpp"

#include <gtest/gtest.h>

#include "support.hpp"

namespace drape::report {
namespace {

TurntableStyle small() {
  TurntableStyle style;
  style.view = {.views = 3, .width_px = 80, .height_px = 80};
  style.background = {1, 1, 1};
  return style;
}

struct Counts {
  int covered = 0;
  int grey = 0;     // the colour of a mesh without colours is nearly grey
  int colored = 0;  // red at least 40 above blue
};

Counts count(const Image8& image) {
  Counts counts;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const int red = image.at(x, y, 0);
      const int blue = image.at(x, y, 2);
      if (red == 255 && image.at(x, y, 1) == 255 && blue == 255) continue;
      ++counts.covered;
      ++(red > blue + 40 ? counts.colored : counts.grey);
    }
  return counts;
}

TEST(Turntable, ShowsAMeshFromEverySide) {
  const Image8 sheet = turntable(test::sphere(2, 24, {5, 5, 5}), small());
  ASSERT_EQ(sheet.width() * sheet.height(), (3 * 88 + 8) * 96);
  const Counts counts = count(sheet);
  // Three discs of 92 % of a cell.
  EXPECT_NEAR(counts.covered, 3 * 3.14159 * 36.8 * 36.8, 450);
  EXPECT_EQ(counts.colored, 0);
}

TEST(Turntable, FilledHolesStandOut) {
  TriangleMesh mesh = test::sphere(1, 24);
  for (const Face& f : mesh.faces) mesh.filled.push_back(mesh.vertices[f[0]].z() > 0.3 ? 1 : 0);
  const Counts counts = count(turntable(mesh, small()));
  EXPECT_GT(counts.colored, counts.covered / 5);
  EXPECT_GT(counts.grey, counts.covered / 5);
}

TEST(Turntable, ShowsTextures) {
  TexturedMesh model;
  model.mesh = test::box({0, 0, 0}, {1, 1, 1});
  Image8 red(4, 4, 3, 0);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) red.at(x, y, 0) = 220;
  model.materials = {{.name = "photo", .image = red, .flat_color = Eigen::Vector3f::Ones()}};
  model.corner_uvs.assign(model.mesh.faces.size(), {Eigen::Vector2f(0.1F, 0.1F), {0.9F, 0.1F}, {0.1F, 0.9F}});
  model.face_materials.assign(model.mesh.faces.size(), 0);
  const Counts counts = count(turntable(model, small()));
  EXPECT_GT(counts.colored, 3000);
  EXPECT_LT(counts.grey, counts.covered / 20);
}

TEST(Turntable, AStrayVertexDoesNotMakeTheMeshSmall) {
  TriangleMesh mesh = test::sphere(1, 16);
  const int before = count(turntable(mesh, small())).covered;
  mesh.vertices.emplace_back(1000, 0, 0);
  EXPECT_EQ(count(turntable(mesh, small())).covered, before);
}

TEST(Turntable, OfNothingIsNothing) {
  EXPECT_TRUE(turntable(TriangleMesh{}).empty());
  EXPECT_TRUE(turntable(TexturedMesh{}).empty());
}

}  // namespace
}  // namespace drape::report
