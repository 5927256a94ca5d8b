#include "drape/rendering/stencil_renderer.hpp"

#include <gtest/gtest.h>

#include "drape/rendering/renderer.hpp"
#include "support.hpp"
#include "test_cameras.hpp"

namespace drape::rendering {
namespace {

void expect_as_renderer(const TriangleMesh& mesh, const Camera& camera) {
  StencilRenderer fast(mesh, camera.width, camera.height);
  Renderer renderer(mesh);
  EXPECT_EQ(fast.draw(camera), renderer.stencil(camera));
}

TEST(StencilRenderer, DrawsWhatRendererDraws) {
  TriangleMesh closed = test::torus(0.7, 0.3, 40, 20);
  TriangleMesh open = closed;
  open.faces.erase(open.faces.begin(), open.faces.begin() + 500);
  TriangleMesh inconsistent = closed;
  for (std::size_t f = 0; f < inconsistent.faces.size(); f += 3)
    std::swap(inconsistent.faces[f][0], inconsistent.faces[f][1]);
  TriangleMesh inward = closed;
  for (Face& face : inward.faces) std::swap(face[0], face[1]);
  for (const TriangleMesh& mesh : {closed, open, inconsistent, inward})
    for (std::uint64_t seed = 0; seed < 6; ++seed)
      for (const auto projection : {Camera::Projection::perspective, Camera::Projection::orthographic})
        expect_as_renderer(mesh, random_camera(seed, projection, 2.5, 160, 120));
}

TEST(StencilRenderer, DrawsAClosedMeshAlsoFromWithinAndWhereItLeavesThePicture) {
  const TriangleMesh mesh = test::torus(0.7, 0.3, 40, 20);
  const Camera within = look_at({0.7, 0, 0}, {0.7, 1, 0}, {0, 0, 1}, 60, 40, 50);
  expect_as_renderer(mesh, within);
  EXPECT_EQ(StencilRenderer(mesh, 60, 40).draw(within), Image8(60, 40, 1, stencil::object));
  expect_as_renderer(mesh, look_at({0, 0, 1.1}, {0.9, 0, 0}, {0, 1, 0}, 200, 150, 50));
  expect_as_renderer(mesh, look_at({0, 0, 5}, {0, 0, 9}, {0, 1, 0}, 60, 40, 50));
  expect_as_renderer(TriangleMesh{}, within);
}

TEST(StencilRenderer, RefusesBadMeshesAndSizes) {
  EXPECT_FALSE(
      test::error_message(ErrorCode::input, [] { StencilRenderer(test::sphere(1, 4), 5000, 10); }).empty());
  TriangleMesh mesh = test::sphere(1, 4);
  mesh.faces[2][1] = 5000;
  EXPECT_FALSE(test::error_message(ErrorCode::input, [&] { StencilRenderer(mesh, 50, 10); }).empty());
}

}  // namespace
}  // namespace drape::rendering
