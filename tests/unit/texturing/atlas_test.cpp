// Several photos on one atlas.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "drape/rendering/renderer.hpp"
#include "painted_object.hpp"
#include "support.hpp"
#include "triangle_raster.hpp"

namespace drape::texturing {
namespace {

const auto everywhere = [](const Eigen::Vector3d&) { return true; };

std::vector<Camera> all_round(int width = 320, int height = 240) {
  std::vector<Camera> cameras;
  for (const Eigen::Vector3d& eye : std::vector<Eigen::Vector3d>{
           {4, 0, 0.3}, {-4, 0, -0.3}, {0.3, 4, 0}, {-0.3, -4, 0}, {0, 0.3, 4}, {0, -0.3, -4}})
    cameras.push_back(look_at(eye, Eigen::Vector3d::Zero(), Eigen::Vector3d(0.1, 0.2, 0.9).normalized(),
                              width, height, 35));
  return cameras;
}

std::vector<Shot> shots_of(const TriangleMesh& mesh, const Paint& paint) {
  std::vector<Shot> shots;
  for (const Camera& camera : all_round()) shots.push_back(photographed(mesh, camera, paint));
  return shots;
}

TextureResult textured(const TriangleMesh& mesh, const std::vector<Shot>& shots,
                       const TextureOptions& options = {}) {
  std::vector<TextureView> views;
  for (const Shot& shot : shots) views.push_back(shot.view());
  const TextureResult result = texture_mesh(mesh, mesh, views, options);
  EXPECT_EQ(problem_of_model(result.model), "");
  EXPECT_NEAR(result.seen_percent + result.filled_percent + result.unseen_percent, 100, 1e-6);
  return result;
}

void brighten(Shot& shot, double factor) {  // of light
  for (std::uint8_t& value : shot.photo.data()) {
    const double stored = value / 255.0;
    const double linear =
        factor * (stored <= 0.04045 ? stored / 12.92 : std::pow((stored + 0.055) / 1.055, 2.4));
    const double again = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    value = static_cast<std::uint8_t>(std::lround(255 * std::min(1.0, again)));
  }
}

// Dark enough that twice the light still fits.
Paint dim_waves() {
  return [bright = waves(0.8)](const Eigen::Vector3d& x) { return Eigen::Vector3d(0.6 * bright(x)); };
}

TEST(Atlas, ShowsTheWholeSphereInItsColours) {
  const TriangleMesh sphere = test::sphere(1, 32);
  const Paint paint = waves(0.8);
  const TextureResult result = textured(sphere, shots_of(sphere, paint));
  EXPECT_EQ(result.unseen_percent, 0);
  EXPECT_LT(result.filled_percent, 0.5);
  ASSERT_EQ(result.model.materials.size(), 1U);
  EXPECT_EQ(result.model.materials[0].name, "atlas_000_color");
  EXPECT_EQ(result.model.materials[0].image.width(), result.model.materials[0].image.height());
  EXPECT_NEAR(result.texels_per_pixel, 1, 1e-12);
  // Colours change by up to 90 * 2 pi / 0.8 * 0.009 = 6 a pixel, which bilinear filters twice.
  EXPECT_LT(largest_error(result.model, paint, everywhere), 6);
  ASSERT_EQ(result.atlas_coverage.size(), 1U);
}

TEST(Atlas, NoTwoFacesShareATexel) {
  const TriangleMesh torus = test::torus(1, 0.4, 32, 16);
  const TextureResult result = textured(torus, shots_of(torus, waves(0.7)));
  const Image8& page = result.model.materials[0].image;
  Image<int> owner(page.width(), page.height(), 1, -1);
  int shared = 0;
  for (std::size_t f = 0; f < result.model.mesh.faces.size(); ++f) {
    if (!is_painted(result.model, f)) continue;
    std::array<Eigen::Vector2d, 3> t;
    for (std::size_t k = 0; k < 3; ++k) t[k] = result.model.corner_uvs[f][k].cast<double>() * page.width();
    for_texels(t, 0, {0, 0, page.width(), page.height()}, [&](int x, int y, const Eigen::Vector3d& weights) {
      if (weights.minCoeff() < 1e-3) return;  // on an edge, texture coordinates being floats
      if (owner.at(x, y) >= 0) ++shared;
      owner.at(x, y) = static_cast<int>(f);
    });
  }
  EXPECT_EQ(shared, 0);
}

TEST(Atlas, PhotosOfOtherExposureAreMatched) {
  const TriangleMesh sphere = test::sphere(1, 32);
  std::vector<Shot> shots = shots_of(sphere, dim_waves());
  const double plain = mean_step_across_seams(textured(sphere, shots).model);
  brighten(shots[0], 1.6);
  brighten(shots[3], 0.7);
  TextureOptions options;
  options.mode = TextureMode::project;
  const double before = mean_step_across_seams(textured(sphere, shots, options).model);
  const double after = mean_step_across_seams(textured(sphere, shots).model);
  EXPECT_GT(before, 10);
  EXPECT_LT(after, 0.05 * before + plain);
  EXPECT_LT(after, 2);
}

TEST(Atlas, LevellingCanBeSwitchedOff) {
  const TriangleMesh sphere = test::sphere(1, 24);
  const Paint paint = dim_waves();
  std::vector<Shot> shots = shots_of(sphere, paint);
  brighten(shots[0], 1.6);
  TextureOptions options;
  options.level_seams = false;
  const auto before_first = [](const Eigen::Vector3d& x) { return x.x() > 0.95; };
  const double kept = largest_error(textured(sphere, shots, options).model, paint, before_first);
  const double levelled = largest_error(textured(sphere, shots).model, paint, before_first);
  EXPECT_GT(kept, 1.5 * levelled);
}

// Two photos say nothing of which of them is right; the colours elsewhere must not suffer from it.
TEST(Atlas, OneDarkPlaceInAPhotoLeavesTheLevelsElsewhere) {
  const TriangleMesh sphere = test::sphere(1, 48);
  const Paint paint = [](const Eigen::Vector3d&) { return Eigen::Vector3d(120, 130, 110); };
  std::vector<Shot> shots;
  for (const Eigen::Vector3d& eye : std::vector<Eigen::Vector3d>{{4, 0, 0}, {0, 4, 0}})
    shots.push_back(photographed(
        sphere, look_at(eye, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), 320, 240, 35), paint));
  Image8& spoilt = shots[0].photo;
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < spoilt.width(); ++x)
      for (int c = 0; c < 3; ++c) spoilt.at(x, y, c) = spoilt.at(x, y, c) / 2;
  const TextureResult result = textured(sphere, shots);
  EXPECT_LT(largest_error(result.model, paint, [](const Eigen::Vector3d& x) { return x.z() < -0.1; }), 4);
}

TEST(Atlas, AHandInOnePhotoIsOutvoted) {
  const TriangleMesh sphere = test::sphere(1, 32);
  const Paint paint = waves(0.8);
  std::vector<Shot> shots = shots_of(sphere, paint);
  for (const Eigen::Vector3d& eye : std::vector<Eigen::Vector3d>{{3, 1.6, 1.6}, {3, -1.6, 1.6}, {3, 0, -2.4}})
    shots.push_back(photographed(
        sphere, look_at(eye, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), 320, 240, 35), paint));
  Image8& photo = shots[0].photo;
  for (int y = 90; y < 150; ++y)
    for (int x = 140; x < 190; ++x)
      for (int c = 0; c < 3; ++c) photo.at(x, y, c) = static_cast<std::uint8_t>(background_color[c]);
  EXPECT_GT(least_distance_to(textured(sphere, shots).model, background_color), 90);
}

TEST(Atlas, TooLargeForAPageGoesOnSeveral) {
  const TriangleMesh sphere = test::sphere(1, 24);
  const Paint paint = waves(1.2);
  TextureOptions options;
  options.atlas_size_px = 200;
  const TextureResult result = textured(sphere, shots_of(sphere, paint), options);
  EXPECT_GT(result.model.materials.size(), 1U);
  for (const Material& m : result.model.materials) EXPECT_LE(m.image.width(), 200);
  EXPECT_LT(largest_error(result.model, paint, everywhere), 8);

  options.atlas_size_px = 64;  // not even a dozen pages hold all pixels
  const TextureResult small = textured(sphere, shots_of(sphere, paint), options);
  EXPECT_LT(small.texels_per_pixel, 1);
  EXPECT_LE(small.model.materials.size(), 12U);
  EXPECT_LT(largest_error(small.model, paint, everywhere), 40);
}

TEST(Atlas, NothingIsPaintedThroughAnOccluder) {
  // A ball in front of a wall, four photos that see the wall past it from different sides.
  TriangleMesh mesh = test::box({-1.5, -0.1, -1.5}, {1.5, 0, 1.5});
  const TriangleMesh ball = test::sphere(0.4, 16, {0, -0.9, 0});
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), ball.vertices.begin(), ball.vertices.end());
  for (const Face& f : ball.faces) mesh.faces.push_back({f[0] + offset, f[1] + offset, f[2] + offset});
  const Eigen::Vector3d red(250, 20, 20);
  const Paint paint = [&](const Eigen::Vector3d& x) {
    return x.y() < -0.3 ? red : Eigen::Vector3d(40, 140, 120 + 60 * std::sin(3 * x.x()));
  };
  std::vector<Shot> shots;
  for (const double side : {-1.5, -0.5, 0.6, 1.6})
    shots.push_back(photographed(
        mesh, look_at({side, -5, 0.3}, {0, 0, 0}, Eigen::Vector3d::UnitZ(), 400, 400, 40), paint));
  TextureResult result = textured(mesh, shots);
  TexturedMesh wall = result.model;
  wall.materials.push_back({"ball", {}, Eigen::Vector3f::Ones()});
  for (std::size_t f = 0; f < wall.mesh.faces.size(); ++f)
    if (wall.mesh.vertices[wall.mesh.faces[f][0]].y() < -0.3)
      wall.face_materials[f] = static_cast<std::uint32_t>(wall.materials.size()) - 1;
  EXPECT_GT(least_distance_to(wall, red), 150);
  // Together they see all of the wall's front but what the ball's guard keeps.
  EXPECT_GT(painted_area(wall), 0.97 * 9);
}

}  // namespace
}  // namespace drape::texturing
