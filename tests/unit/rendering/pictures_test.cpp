#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "drape/rendering/renderer.hpp"
#include "support.hpp"
#include "test_cameras.hpp"

namespace drape::rendering {
namespace {

std::array<int, 3> rgb(const Image8& picture, int x, int y) {
  return {picture.at(x, y, 0), picture.at(x, y, 1), picture.at(x, y, 2)};
}

// A unit square in the plane z = 0 that fills the image of front_camera() exactly, (0, 0) top left.
TriangleMesh square() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.faces = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

Camera front_camera(int side) {
  Camera camera;
  camera.projection = Camera::Projection::orthographic;
  camera.width = camera.height = side;
  camera.K.diagonal() << side, side, 1;
  camera.camera_from_world.translation().z() = 2;
  return camera;
}

TexturedMesh textured_square(Image8 image) {
  TexturedMesh model;
  model.mesh = square();
  model.corner_uvs = {{{{0, 0}, {1, 0}, {1, 1}}}, {{{0, 0}, {1, 1}, {0, 1}}}};
  model.face_materials = {0, 0};
  model.materials = {{"front", std::move(image), Eigen::Vector3f::Ones()}};
  return model;
}

Image8 numbered_image(int side) {
  Image8 image(side, side, 3);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      image.at(x, y, 0) = static_cast<std::uint8_t>(10 + 20 * x);
      image.at(x, y, 1) = static_cast<std::uint8_t>(250 - 25 * y);
      image.at(x, y, 2) = static_cast<std::uint8_t>(x * y);
    }
  return image;
}

TEST(Shaded, GivesTheSidesOfABoxTheirOwnBrightnessWithHardEdges) {
  Renderer renderer(test::box({-1, -1, -1}, {1, 1, 1}));
  const Camera camera = look_at({4, 3, 5}, {0, 0, 0}, {0, 1, 0}, 200, 200, 30);
  const Image8 picture = renderer.shaded(camera);
  std::vector<std::array<int, 3>> sides;
  for (const Eigen::Vector3d normal :
       {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()}) {
    const auto color_at = [&](const Eigen::Vector3d& point) {
      const Eigen::Vector2d pixel = camera.project(point).pixel;
      return rgb(picture, static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
    };
    const std::array<int, 3> middle = color_at(normal);
    // Flat up to close to the edges (a glint may vary it a little).
    const Eigen::Vector3d towards_edge = 0.85 * (Eigen::Vector3d::Ones() - normal);
    EXPECT_NEAR(color_at(normal + towards_edge)[0], middle[0], 6);
    EXPECT_NEAR(color_at(normal - towards_edge)[0], middle[0], 6);
    sides.push_back(middle);
  }
  EXPECT_GT(std::abs(sides[0][0] - sides[1][0]), 15);
  EXPECT_GT(std::abs(sides[1][0] - sides[2][0]), 15);
  EXPECT_GT(std::abs(sides[0][0] - sides[2][0]), 15);
}

TEST(Shaded, LightsBothSidesOfAFaceAlike) {
  TriangleMesh mesh = test::torus(0.7, 0.3, 24, 12);
  const Camera camera = random_camera(2, Camera::Projection::perspective, 4, 90, 70);
  const Image8 picture = Renderer(mesh).shaded(camera);
  for (Face& face : mesh.faces) std::swap(face[0], face[1]);
  EXPECT_EQ(Renderer(mesh).shaded(camera), picture);
  std::swap(mesh.faces[7][0], mesh.faces[7][1]);  // one that disagrees with its neighbours
  const Image8 mixed = Renderer(mesh).shaded(camera);
  int differ = 0;
  for (std::size_t i = 0; i < mixed.data().size(); ++i)
    differ += std::abs(mixed.data()[i] - picture.data()[i]) > 2 ? 1 : 0;
  EXPECT_EQ(differ, 0);
}

TEST(Shaded, ShowsColoursFilledFacesAndBackgroundAsAsked) {
  TriangleMesh mesh = square();
  mesh.colors.assign(4, Eigen::Vector3f(0.1F, 0.7F, 0.2F));
  mesh.filled = {0, 1};
  Renderer renderer(mesh);
  Camera camera = front_camera(20);
  camera.K(0, 0) = camera.K(1, 1) = 10;
  ShadedStyle style;
  style.background = {0, 0, 1};
  const Image8 own = renderer.shaded(camera, style);
  EXPECT_EQ(rgb(own, 15, 15), (std::array<int, 3>{0, 0, 255}));
  EXPECT_GT(own.at(7, 3, 1), own.at(7, 3, 0) + 50);  // green above the diagonal
  EXPECT_EQ(rgb(own, 7, 3), rgb(own, 3, 7));

  style.highlight_filled = true;
  const Image8 marked = renderer.shaded(camera, style);
  EXPECT_EQ(rgb(marked, 7, 3), rgb(own, 7, 3));
  EXPECT_GT(marked.at(3, 7, 0), marked.at(3, 7, 2) + 50);  // orange below

  style = {};
  style.vertex_colors = false;
  style.color = {1, 0, 0};
  const Image8 red = renderer.shaded(camera, style);
  EXPECT_GT(red.at(7, 3, 0), red.at(7, 3, 1) + 50);
}

TEST(Shaded, SamplesSoftenTheOutline) {
  TriangleMesh mesh = square();
  Renderer renderer(mesh);
  Camera camera = front_camera(10);
  camera.K.diagonal() << 5.5, 5.5, 1;  // the outline passes through the middle of a pixel
  ShadedStyle style;
  style.color = {0, 0, 0};
  style.samples_per_side = 1;
  const Image8 hard = renderer.shaded(camera, style);
  style.samples_per_side = 4;
  const Image8 soft = renderer.shaded(camera, style);
  EXPECT_LT(hard.at(4, 2), 80);
  EXPECT_EQ(hard.at(6, 2), 255);
  EXPECT_NEAR(soft.at(5, 2), 191, 8);  // half of the light: 0.5 is stored as 188
  EXPECT_EQ(soft.at(6, 2), 255);
}

TEST(RenderTextured, ShowsTexelsWhereTheyBelong) {
  const Image8 image = numbered_image(8);
  TexturedStyle style;
  style.samples_per_side = 1;
  // One pixel per texel: pixel centres fall on texel centres, and bilinear filtering changes nothing.
  const Image8 picture = render_textured(textured_square(image), front_camera(8), style);
  for (std::size_t i = 0; i < image.data().size(); ++i)
    EXPECT_NEAR(picture.data()[i], image.data()[i], 2) << "value " << i;
}

TEST(RenderTextured, InterpolatesBetweenTexelsAndAveragesWhenSmall) {
  Image8 halves(2, 2, 3, 0);
  for (int y = 0; y < 2; ++y)
    for (int c = 0; c < 3; ++c) halves.at(1, y, c) = 255;
  const Image8 large = render_textured(textured_square(halves), front_camera(64));
  EXPECT_EQ(large.at(4, 30), 0);
  EXPECT_EQ(large.at(60, 30), 255);
  EXPECT_NEAR(large.at(32, 30), 188, 4);  // half of the light
  Image8 stripes(256, 256, 3, 0);
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; x += 2)
      for (int c = 0; c < 3; ++c) stripes.at(x, y, c) = 255;
  const Image8 small = render_textured(textured_square(stripes), front_camera(16));
  for (const std::uint8_t value : small.data()) EXPECT_NEAR(value, 188, 4);
}

TEST(RenderTextured, UsesEveryFacesOwnMaterial) {
  TexturedMesh model = textured_square(Image8(2, 2, 3, 200));
  model.materials.push_back({"flat", Image8(), Eigen::Vector3f(1, 0.5F, 0)});
  model.face_materials = {1, 0};
  const Image8 picture = render_textured(model, front_camera(16));
  const auto expect_flat = [&](int x, int y) {
    EXPECT_EQ(picture.at(x, y, 0), 255);
    EXPECT_NEAR(picture.at(x, y, 1), 128, 1);
    EXPECT_EQ(picture.at(x, y, 2), 0);
  };
  expect_flat(12, 3);
  EXPECT_EQ(rgb(picture, 3, 12), (std::array<int, 3>{200, 200, 200}));

  model.mesh.colors.assign(4, Eigen::Vector3f(0, 1, 1));  // times the flat colour, not the image
  const Image8 tinted = render_textured(model, front_camera(16));
  EXPECT_EQ(tinted.at(12, 3, 0), 0);
  EXPECT_NEAR(tinted.at(12, 3, 1), 128, 1);
  EXPECT_EQ(rgb(tinted, 3, 12), (std::array<int, 3>{200, 200, 200}));
}

TEST(RenderTextured, IsLitOnlyIfAsked) {
  TexturedMesh model = textured_square(Image8(1, 1, 3, 180));
  TexturedStyle style;
  EXPECT_EQ(rgb(render_textured(model, front_camera(4), style), 2, 2), (std::array<int, 3>{180, 180, 180}));
  style.lit = true;
  const Image8 lit = render_textured(model, front_camera(4), style);
  EXPECT_GT(lit.at(2, 2), 120);
  EXPECT_NE(lit.at(2, 2), 180);
  model.mesh.vertices[1].z() = model.mesh.vertices[2].z() = 3;  // turned away from the light
  EXPECT_LT(render_textured(model, front_camera(4), style).at(2, 2), lit.at(2, 2) - 20);
}

TEST(RenderTextured, HidesWhatIsBehind) {
  TexturedMesh model = textured_square(Image8(1, 1, 3, 50));
  const TriangleMesh back = square();
  for (Eigen::Vector3d x : back.vertices) model.mesh.vertices.push_back(x + Eigen::Vector3d(0, 0, 1e-4));
  for (const Face& f : back.faces) model.mesh.faces.push_back({f[0] + 4, f[1] + 4, f[2] + 4});
  model.corner_uvs.resize(4);
  model.face_materials = {0, 0, 1, 1};
  model.materials.push_back({"back", Image8(), Eigen::Vector3f(1, 0, 0)});
  EXPECT_EQ(rgb(render_textured(model, front_camera(6)), 2, 3), (std::array<int, 3>{50, 50, 50}));
}

TEST(RenderTextured, RefusesWhatDoesNotFitTogether) {
  TexturedMesh model = textured_square(Image8(1, 1, 3, 50));
  model.face_materials = {0, 4};
  EXPECT_NE(test::error_message(ErrorCode::input, [&] { (void)render_textured(model, front_camera(4)); })
                .find("material 4"),
            std::string::npos);
  model.face_materials = {0};
  EXPECT_FALSE(
      test::error_message(ErrorCode::input, [&] { (void)render_textured(model, front_camera(4)); }).empty());
  model = textured_square(Image8(2, 2, 4, 50));
  EXPECT_NE(test::error_message(ErrorCode::input, [&] { (void)render_textured(model, front_camera(4)); })
                .find("front"),
            std::string::npos);
  EXPECT_EQ(render_textured(TexturedMesh{}, front_camera(4)), Image8(4, 4, 3, 255));
}

}  // namespace
}  // namespace drape::rendering
