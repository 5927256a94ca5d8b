#include "photo_sight.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "drape/rendering/depth_raster.hpp"
#include "view_choice.hpp"

namespace drape::texturing {
namespace {

// From so far away that a pixel is about a unit wide and rays are all but parallel.
Camera far_camera() {
  Camera camera;
  camera.width = camera.height = 40;
  camera.K << 1e4, 0, 20, 0, 1e4, 20, 0, 0, 1;
  camera.camera_from_world = Rigid3(Eigen::Translation3d(0, 0, 1e4));
  return camera;
}

Eigen::Vector3d at(const Camera& camera, double x, double y, double depth) {
  return camera.unproject({x, y}, 1e4 + depth);
}

void add_quad(TriangleMesh& mesh, const std::array<Eigen::Vector3d, 4>& corners) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  mesh.faces.push_back({first, first + 2, first + 1});
  mesh.faces.push_back({first, first + 3, first + 2});
}

TEST(PhotoSight, NothingHiddenIsSeenAtTheEndOfASurfaceThatRecedesSteeply) {
  const Camera camera = far_camera();
  TriangleMesh mesh;
  // Five units deeper from each row to the next, beginning within row 9.
  const auto depth_at = [](double y) { return 100 + 5 * y; };
  add_quad(mesh, {at(camera, 2, 9.9, depth_at(9.9)), at(camera, 38, 9.9, depth_at(9.9)),
                  at(camera, 38, 30, depth_at(30)), at(camera, 2, 30, depth_at(30))});
  // Ends before it, hiding less than half a row of it from 2.7 units in front: where it fills pixels, it lies
  // behind the plane of the other.
  add_quad(mesh, {at(camera, 2, 2, 147.4), at(camera, 38, 2, 147.4), at(camera, 38, 10.3, 147.4),
                  at(camera, 2, 10.3, 147.4)});
  const RayCaster caster(mesh);
  const PhotoSight sight(camera, {}, rendering::rastered_depth(mesh, camera).depth,
                         Image8(camera.width, camera.height, 1, trust::full), 1e-5, 85, caster);
  const Eigen::Vector3d normal = scaled_face_normal(mesh, 0).stableNormalized();
  const auto sees = [&](double y) { return sight.sees(at(camera, 20.3, y, depth_at(y)), normal, normal); };
  ASSERT_GT(normal.dot(camera.towards_camera(mesh.vertices[0])), 0);
  EXPECT_EQ(sees(10.02), trust::none);
  EXPECT_EQ(sees(10.2), trust::none);
  EXPECT_EQ(sees(10.8), trust::full);
  EXPECT_EQ(sees(20), trust::full);
  const auto plainly = [&](double top, double bottom) {
    const std::array<Eigen::Vector3d, 3> corners{at(camera, 20, top, depth_at(top)),
                                                 at(camera, 20.5, bottom, depth_at(bottom)),
                                                 at(camera, 20.5, top, depth_at(top))};
    return sight.sees_plainly(
        corners, {camera.project(corners[0]), camera.project(corners[1]), camera.project(corners[2])},
        {normal, normal, normal}, normal);
  };
  EXPECT_FALSE(plainly(10.02, 10.2));
  EXPECT_TRUE(plainly(20, 20.5));
}

TEST(DropHidden, AnExactRayHasTheLastWordOnSlivers) {
  const Camera camera = far_camera();
  TriangleMesh mesh;
  add_quad(mesh, {at(camera, 2, 2, 100), at(camera, 38, 2, 100), at(camera, 38, 10.3, 100),
                  at(camera, 2, 10.3, 100)});
  const RayCaster front(mesh);
  PhotoSight sight(camera, {}, rendering::rastered_depth(mesh, camera).depth,
                   Image8(camera.width, camera.height, 1, trust::full), 1e-5, 85, front);
  PaintedFaces behind;
  // Half a pixel wide on either side of where the front ends.
  for (const double y : {10.0, 10.4})
    add_quad(behind.mesh, {at(camera, 20, y, 105), at(camera, 20.5, y, 105), at(camera, 20.5, y + 0.2, 105),
                           at(camera, 20, y + 0.2, 105)});
  std::vector<int> chosen = {0, no_view, 0, 0};
  drop_hidden(behind, std::span(&sight, 1), chosen);
  EXPECT_EQ(chosen, (std::vector<int>{no_view, no_view, 0, 0}));
}

}  // namespace
}  // namespace drape::texturing
