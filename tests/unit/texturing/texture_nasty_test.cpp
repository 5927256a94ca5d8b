#include <gtest/gtest.h>

#include <limits>

#include "painted_object.hpp"
#include "support.hpp"

namespace drape::texturing {
namespace {

Camera at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, int width, int height) {
  return look_at(eye, target, Eigen::Vector3d::UnitZ(), width, height, 40);
}

// A photo that says of itself that all of it shows the object.
struct PlainShot {
  Image8 photo;
  Image8 no_stencil;
  Camera camera;
  explicit PlainShot(const Camera& c) : photo(c.width, c.height, 3, 77), camera(c) {}
  [[nodiscard]] TextureView view() const { return {photo, camera, no_stencil, "photo"}; }
};

TextureResult textured(const TriangleMesh& mesh, const PlainShot& shot) {
  const TextureResult result = texture_mesh(mesh, mesh, std::vector<TextureView>{shot.view()}, {});
  EXPECT_EQ(problem_of_model(result.model), "");
  return result;
}

void expect_all_unseen(const TextureResult& result, const TriangleMesh& mesh) {
  EXPECT_NEAR(result.unseen_percent, 100, 1e-9);
  EXPECT_EQ(result.model.mesh.faces, mesh.faces);
  ASSERT_EQ(result.model.materials.size(), 1U);
  EXPECT_EQ(result.model.materials[0].name, "unseen");
}

TEST(NastyViews, NoPhotoAtAll) {
  const TriangleMesh sphere = test::sphere(1, 8);
  expect_all_unseen(texture_mesh(sphere, sphere, {}, {}), sphere);
}

TEST(NastyViews, APhotoThatLooksAway) {
  const TriangleMesh sphere = test::sphere(1, 8);
  const TextureResult result = textured(sphere, PlainShot(at({4, 0, 0}, {8, 0, 0}, 60, 40)));
  expect_all_unseen(result, sphere);
  EXPECT_NE(result.views[0].reason, "");
  EXPECT_EQ(result.coverage[0].width(), 60);
}

TEST(NastyViews, ARejectedPhotoIsNotDraped) {
  const TriangleMesh sphere = test::sphere(1, 8);
  const PlainShot shot(at({4, 0, 0}, {0, 0, 0}, 60, 40));
  TextureView view = shot.view();
  view.usable = false;
  const TextureResult result = texture_mesh(sphere, sphere, std::vector<TextureView>{view}, {});
  expect_all_unseen(result, sphere);
  EXPECT_TRUE(result.coverage[0].empty());
}

TEST(NastyViews, ACameraInsideTheMeshSeesNoOutside) {
  const TriangleMesh sphere = test::sphere(1, 8);
  expect_all_unseen(textured(sphere, PlainShot(at({0.2, 0, 0}, {1, 0, 0}, 60, 40))), sphere);
}

TEST(NastyViews, ACameraInTheMiddleOfAFaceOrOnAVertex) {
  const TriangleMesh box = test::box({-1, -1, -1}, {1, 1, 1});
  (void)textured(box, PlainShot(at({1, 0.3, 0.2}, {0, 0, 0}, 60, 40)));
  (void)textured(box, PlainShot(at({1, 1, 1}, {0, 0, 0}, 60, 40)));
}

TEST(NastyViews, AFaceThatReachesBehindTheCamera) {
  TriangleMesh floor;
  floor.vertices = {{-100, -100, 0}, {100, -100, 0}, {100, 100, 0}, {-100, 100, 0}};
  floor.faces = {{0, 1, 2}, {0, 2, 3}};
  const TextureResult result = textured(floor, PlainShot(at({0, 0, 2}, {3, 0, 0}, 120, 90)));
  EXPECT_GT(result.seen_percent, 0.01);
  EXPECT_LT(result.seen_percent, 1);
}

TEST(NastyViews, APhotoOfOnePixel) {
  const TriangleMesh sphere = test::sphere(1, 8);
  const TextureResult result = textured(sphere, PlainShot(at({4, 0, 0}, {0, 0, 0}, 1, 1)));
  EXPECT_GT(result.seen_percent, 1);
  EXPECT_EQ(result.model.materials[0].image.width(), 1);
}

TEST(NastyViews, APhotoWiderThanADepthPicture) {
  const TriangleMesh sphere = test::sphere(1, 8);
  PlainShot shot(look_at({6, 0, 0}, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), 20000, 24, 100));
  for (int y = 0; y < 24; ++y)
    for (int x = 10000; x < 20000; ++x)
      for (int c = 0; c < 3; ++c) shot.photo.at(x, y, c) = 177;
  const TextureResult result = textured(sphere, shot);
  EXPECT_GT(result.seen_percent, 0);
  ASSERT_FALSE(result.model.materials.empty());
  // The left half of the photo is darker: so is what it paints.
  const Image8& image = result.model.materials[0].image;
  EXPECT_EQ(image.at(0, 0), 77);
  EXPECT_EQ(image.at(image.width() - 1, 0), 177);
}

TEST(NastyViews, AStencilWithoutObjectPixels) {
  const TriangleMesh sphere = test::sphere(1, 8);
  const PlainShot shot(at({4, 0, 0}, {0, 0, 0}, 60, 40));
  const Image8 nothing(60, 40, 1, stencil::background);
  const TextureResult result =
      texture_mesh(sphere, sphere, std::vector<TextureView>{{shot.photo, shot.camera, nothing, "empty"}}, {});
  expect_all_unseen(result, sphere);
}

TEST(NastyMeshes, FacesWithoutAreaAndInsideOutMeshes) {
  TriangleMesh sphere = test::sphere(1, 8);
  sphere.faces.push_back({0, 0, 1});
  sphere.faces.push_back({3, 4, 3});
  const PlainShot shot(at({4, 0, 0}, {0, 0, 0}, 60, 40));
  const TextureResult result = textured(sphere, shot);
  EXPECT_GT(result.seen_percent, 20);

  TriangleMesh inside_out = test::sphere(1, 8);
  for (Face& f : inside_out.faces) std::swap(f[1], f[2]);
  EXPECT_GT(textured(inside_out, shot).unseen_percent, 95);  // its far inside, behind its near back faces
}

TEST(NastyMeshes, NamesOfMaterialsAreCleanAndDifferent) {
  const TriangleMesh sphere = test::sphere(1, 8);
  const PlainShot front(at({4, 0, 0}, {0, 0, 0}, 60, 40));
  const PlainShot back(at({-4, 0, 0}, {0, 0, 0}, 60, 40));
  std::vector<TextureView> views;
  views.push_back({front.photo, front.camera, front.no_stencil, "unseen é.jpg"});
  views.push_back({back.photo, back.camera, back.no_stencil, "unseen é.jpg"});
  TextureOptions options;
  options.mode = TextureMode::project;
  const TextureResult result = texture_mesh(sphere, sphere, views, options);
  ASSERT_EQ(result.model.materials.size(), 3U);
  for (const Material& m : result.model.materials)
    EXPECT_EQ(m.name.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_"),
              std::string::npos);
  EXPECT_NE(result.model.materials[0].name, result.model.materials[1].name);
}

TEST(BadInput, IsRefusedInWords) {
  const TriangleMesh sphere = test::sphere(1, 8);
  const PlainShot shot(at({4, 0, 0}, {0, 0, 0}, 60, 40));
  const auto message = [&](const TriangleMesh& mesh, const TextureView& view) {
    return test::error_message(ErrorCode::input,
                               [&] { (void)texture_mesh(mesh, mesh, std::vector<TextureView>{view}, {}); });
  };
  TriangleMesh flat = sphere;
  for (Eigen::Vector3d& x : flat.vertices) x = {1, 2, 3};
  EXPECT_NE(message(flat, shot.view()).find("no area"), std::string::npos);
  EXPECT_NE(message({}, shot.view()).find("no area"), std::string::npos);
  TriangleMesh broken = sphere;
  broken.faces[3][1] = 100000;
  EXPECT_NE(message(broken, shot.view()).find("cannot be textured"), std::string::npos);
  const Image8 small_stencil(10, 10, 1);
  EXPECT_NE(message(sphere, {shot.photo, shot.camera, small_stencil, "a.jpg"})
                .find("photo a.jpg: its stencil is 10 x 10"),
            std::string::npos);
  const Image8 other_size(30, 20, 3);
  EXPECT_NE(
      message(sphere, {other_size, shot.camera, shot.no_stencil, "a.jpg"}).find("its camera is for 60 x 40"),
      std::string::npos);
  Camera no_camera = shot.camera;
  no_camera.K(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(message(sphere, {shot.photo, no_camera, shot.no_stencil, "a.jpg"}).find("make no camera"),
            std::string::npos);
}

}  // namespace
}  // namespace drape::texturing
