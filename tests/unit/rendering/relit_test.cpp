#include "drape/rendering/relit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "drape/base/error.hpp"
#include "support.hpp"

namespace drape::rendering {
namespace {

double linear(int stored) {
  const double s = stored / 255.0;
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

// A grey floor of 4 x 4 with a cube of 1 on its middle.
TexturedMesh cube_on_a_floor() {
  TexturedMesh model;
  model.mesh = test::box({-0.5, -0.5, 0}, {0.5, 0.5, 1});
  const auto first = static_cast<std::uint32_t>(model.mesh.vertices.size());
  for (const Eigen::Vector3d& x : {Eigen::Vector3d(-2, -2, 0), Eigen::Vector3d(2, -2, 0),
                                   Eigen::Vector3d(2, 2, 0), Eigen::Vector3d(-2, 2, 0)})
    model.mesh.vertices.push_back(x);
  model.mesh.faces.push_back({first, first + 1, first + 2});
  model.mesh.faces.push_back({first, first + 2, first + 3});
  model.materials = {{"grey", {}, Eigen::Vector3f::Constant(0.5F)}};
  model.face_materials.assign(model.mesh.faces.size(), 0);
  model.corner_uvs.resize(model.mesh.faces.size());
  for (auto& corners : model.corner_uvs) corners.fill(Eigen::Vector2f::Zero());
  return model;
}

// 4 x 4 units from above, x to the right, y up the picture, 100 pixels.
Camera from_above() {
  Camera camera;
  camera.projection = Camera::Projection::orthographic;
  camera.width = camera.height = 100;
  camera.K << 25, 0, 50, 0, 25, 50, 0, 0, 1;
  camera.camera_from_world.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  camera.camera_from_world.translation() = Eigen::Vector3d(0, 0, 5);
  return camera;
}

RelitStyle light_from(const Eigen::Vector3d& towards) {
  RelitStyle style;
  style.towards_light = towards;
  style.ambient = 0;
  style.softness_deg = 0;
  style.shadow_map_px = 256;
  return style;
}

double grey_at(const Image8& picture, double x, double y) {
  return linear(picture.at(static_cast<int>(50 + 25 * x), static_cast<int>(50 - 25 * y)));
}

TEST(Relit, ShadowsLieWhereTheLampCastsThemAndMoveWithIt) {
  const TexturedMesh model = cube_on_a_floor();
  // At 45 degrees the cube's shadow is as long as the cube is high.
  const Image8 from_left = render_relit(model, from_above(), light_from({-1, 0, 1}));
  EXPECT_LT(grey_at(from_left, 0.9, 0), 0.01);
  EXPECT_LT(grey_at(from_left, 1.4, 0), 0.01);
  EXPECT_GT(grey_at(from_left, 1.65, 0), 0.1);
  EXPECT_GT(grey_at(from_left, -0.9, 0), 0.1);
  const Image8 from_right = render_relit(model, from_above(), light_from({1, 0, 1}));
  EXPECT_GT(grey_at(from_right, 0.9, 0), 0.1);
  EXPECT_LT(grey_at(from_right, -0.9, 0), 0.01);
}

TEST(Relit, LightGrowsWithTheIntensityAndTheCosine) {
  const TexturedMesh model = cube_on_a_floor();
  const double paint = linear(128);
  RelitStyle style = light_from({0, 0, 1});
  style.intensity = 0.5;
  EXPECT_NEAR(grey_at(render_relit(model, from_above(), style), 1.5, 1.5), 0.5 * paint, 0.003);
  style.intensity = 2;
  EXPECT_NEAR(grey_at(render_relit(model, from_above(), style), 1.5, 1.5), 2 * paint, 0.006);
  style.intensity = 1;
  style.towards_light = {-std::sqrt(3.0), 0, 1};
  EXPECT_NEAR(grey_at(render_relit(model, from_above(), style), -1.5, 1.5), 0.5 * paint, 0.003);
  style.intensity = 0;
  style.ambient = 0.25;
  EXPECT_NEAR(grey_at(render_relit(model, from_above(), style), 1.5, 1.5), 0.25 * paint, 0.003);
}

TEST(Relit, ASoftLampHasAHalfShadow) {
  const TexturedMesh model = cube_on_a_floor();
  RelitStyle style = light_from({-1, 0, 1});
  style.softness_deg = 12;
  const Image8 soft = render_relit(model, from_above(), style);
  const double lit = grey_at(soft, -1.5, 1.5);
  EXPECT_GT(grey_at(soft, 1.5, 0), 0.15 * lit);
  EXPECT_LT(grey_at(soft, 1.5, 0), 0.85 * lit);
  EXPECT_LT(grey_at(soft, 0.6, 0), 0.05 * lit);
}

TEST(Relit, NormalMapsBendTheNormals) {
  TexturedMesh model;
  model.mesh.vertices = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
  model.mesh.faces = {{0, 1, 2}, {0, 2, 3}};
  model.face_materials = {0, 0};
  model.corner_uvs = {{{{0, 1}, {1, 1}, {1, 0}}}, {{{0, 1}, {1, 0}, {0, 0}}}};
  Material material;
  material.name = "white";
  material.image = Image8(2, 2, 3, 255);
  material.normal_map = Image8(2, 2, 3);
  // Leaning to +x by 30 degrees at the top of the picture, to +y at the bottom.
  for (int x = 0; x < 2; ++x)
    for (int y = 0; y < 2; ++y) {
      material.normal_map.at(x, y, 0) = y == 0 ? 191 : 128;
      material.normal_map.at(x, y, 1) = y == 0 ? 128 : 191;
      material.normal_map.at(x, y, 2) = 238;
    }
  model.materials = {material};
  const Eigen::Vector3d towards = Eigen::Vector3d(1, 0, 1).normalized();
  const Image8 picture = render_relit(model, from_above(), light_from(towards));
  const double deg = std::acos(-1.0) / 180;
  EXPECT_NEAR(grey_at(picture, 1, 1.8), std::cos(15 * deg), 0.01);
  EXPECT_NEAR(grey_at(picture, 1, -1.8), std::cos(30 * deg) * std::cos(45 * deg), 0.01);
}

TEST(Relit, RefusesALightFromNowhere) {
  EXPECT_THROW((void)render_relit(cube_on_a_floor(), from_above(), light_from({0, 0, 0})), Error);
}

}  // namespace
}  // namespace drape::rendering
