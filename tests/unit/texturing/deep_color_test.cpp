// Models painted in 16 bits a channel.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "drape/io/model_files.hpp"
#include "drape/io/photo.hpp"
#include "linear_light.hpp"
#include "painted_object.hpp"
#include "support.hpp"

namespace drape::texturing {
namespace {

constexpr int side = 240;
constexpr double half = 1;  // of the square's side

// A square that fills the photo of `camera()` but for a margin.
TriangleMesh square() {
  TriangleMesh mesh;
  mesh.vertices = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
  mesh.faces = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}
Camera camera() {
  Camera camera;
  camera.projection = Camera::Projection::orthographic;
  camera.width = side;
  camera.height = side;
  constexpr double px_per_unit = 100;
  camera.K << px_per_unit, 0, side / 2.0, 0, px_per_unit, side / 2.0, 0, 0, 1;
  camera.camera_from_world.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  camera.camera_from_world.translation() = Eigen::Vector3d(0, 0, 10);
  return camera;
}

// Stored values of a gradient so flat that bytes would show it as some ten steps.
double gradient(double x_px, int channel) {
  return 30000 + 4000 * channel + 12.0 * x_px;
}
Image16 gradient_photo() {
  Image16 photo(side, side, 3);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      for (int c = 0; c < 3; ++c) photo.at(x, y, c) = static_cast<std::uint16_t>(gradient(x, c));
  return photo;
}

TextureResult textured(const Image16& photo, TextureOptions options, std::size_t views, bool deep = true) {
  const Image8 rgb = bytes_from_deep(photo);
  const Image8 stencil;
  options.pose_max_px = 0;
  TextureView view{rgb, camera(), stencil, "photo"};
  if (deep) view.deep_rgb = &photo;
  return texture_mesh(square(), square(), std::vector<TextureView>(views, view), options);
}

struct Likeness {
  std::size_t levels;  // different red values of the texels that the surface shows
  double worst;        // difference to the gradient
};
Likeness likeness(const TexturedMesh& model) {
  std::set<int> levels;
  double worst = 0;
  for (std::size_t f = 0; f < model.mesh.faces.size(); ++f) {
    const Image16& image = model.materials[model.face_materials[f]].deep_image;
    if (image.empty()) continue;
    constexpr int n = 300;
    for (int i = 1; i < n; ++i)
      for (int j = 1; i + j < n; ++j) {
        Eigen::Vector2d uv = Eigen::Vector2d::Zero();
        Eigen::Vector3d point = Eigen::Vector3d::Zero();
        const std::array<double, 3> weights = {1 - double(i + j) / n, double(i) / n, double(j) / n};
        for (std::size_t k = 0; k < 3; ++k) {
          uv += weights[k] * model.corner_uvs[f][k].cast<double>();
          point += weights[k] * model.mesh.vertices[model.mesh.faces[f][k]];
        }
        if (point.cwiseAbs().maxCoeff() > 0.9) continue;  // the rim mirrors and grows
        const double u = uv.x() * image.width() - 0.5;
        const double v = uv.y() * image.height() - 0.5;
        const auto x = static_cast<int>(u);
        const auto y = static_cast<int>(v);
        levels.insert(image.at(x, y, 0));
        for (int c = 0; c < 3; ++c) {
          const double shown =
              (1 - (v - y)) * ((1 - (u - x)) * image.at(x, y, c) + (u - x) * image.at(x + 1, y, c)) +
              (v - y) * ((1 - (u - x)) * image.at(x, y + 1, c) + (u - x) * image.at(x + 1, y + 1, c));
          worst = std::max(worst, std::abs(shown - gradient(camera().project(point).pixel.x() - 0.5, c)));
        }
      }
  }
  return {levels.size(), worst};
}

TEST(DeepColor, KeepsWhatASixteenBitPhotoShows) {
  for (const TextureMode mode : {TextureMode::project, TextureMode::atlas})
    for (const std::size_t views : {1U, 2U}) {
      TextureOptions options;
      options.mode = mode;
      options.color_bits = ColorBits::sixteen;
      const TextureResult result = textured(gradient_photo(), options, views);
      for (const Material& m : result.model.materials) {
        ASSERT_EQ(m.deep_image.empty(), m.image.empty());
        EXPECT_EQ(m.image, m.deep_image.empty() ? Image8() : bytes_from_deep(m.deep_image));
      }
      const Likeness like = likeness(result.model);
      EXPECT_GT(like.levels, 150U);  // of the 180 columns that are looked at; bytes have nine
      EXPECT_LT(like.worst, 8);      // of 65535; a byte's step is 257
    }
}

TEST(DeepColor, TheLightIsTakenOutInSixteenBitsToo) {
  TextureOptions options;
  options.color_bits = ColorBits::sixteen;
  options.delight = true;
  const TextureResult result = textured(gradient_photo(), options, 1);
  ASSERT_TRUE(result.albedo);
  EXPECT_GT(likeness(*result.albedo).levels, 150U);
}

TEST(DeepColor, EightBitPhotosAreBlendedInSixteen) {
  TextureOptions options;
  options.mode = TextureMode::atlas;
  options.color_bits = ColorBits::sixteen;
  const Likeness like = likeness(textured(gradient_photo(), options, 2, false).model);
  EXPECT_GE(like.levels, 9U);
  EXPECT_LT(like.worst, 257);
}

TEST(DeepColor, IsNotThereUnlessAskedFor) {
  for (const TextureMode mode : {TextureMode::project, TextureMode::atlas}) {
    TextureOptions options;
    options.mode = mode;
    for (const Material& m : textured(gradient_photo(), options, 1).model.materials)
      EXPECT_TRUE(m.deep_image.empty());
  }
}

TEST(DeepColor, OfAnotherSizeIsRefusedInWords) {
  const Image16 small(side / 2, side, 3);
  const Image8 rgb(side, side, 3);
  const Image8 stencil;
  TextureView view{rgb, camera(), stencil, "photo"};
  view.deep_rgb = &small;
  EXPECT_NE(
      test::error_message(ErrorCode::input,
                          [&] { (void)texture_mesh(square(), square(), std::vector<TextureView>{view}, {}); })
          .find("has 120 x 240 pixels of 16 bits"),
      std::string::npos);
}

TEST(LinearLight, GoesThereAndBackForEverySixteenBitValue) {
  for (int i = 0; i <= 65535; ++i) {
    const auto value = static_cast<std::uint16_t>(i);
    ASSERT_EQ(stored_as<std::uint16_t>(linear_from(value)), value);
  }
}

}  // namespace
}  // namespace drape::texturing
