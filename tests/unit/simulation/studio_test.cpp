#include "drape/simulation/studio.hpp"

#include <gtest/gtest.h>

#include "support.hpp"

namespace drape::simulation {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

TEST(Studio, LightsTheSideOfTheLampAndCastsAShadow) {
  // A small ball over a large one, the lamp straight above.
  Subject subject;
  subject.mesh = test::sphere(1, 24);
  const TriangleMesh ball = test::sphere(0.3, 12);
  const auto first = static_cast<std::uint32_t>(subject.mesh.vertices.size());
  for (const Vector3d& x : ball.vertices) subject.mesh.vertices.push_back(x + Vector3d(0, 0, 2));
  for (const Face& f : ball.faces) subject.mesh.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
  subject.mesh.normals = vertex_normals(subject.mesh);
  subject.color = [](const Vector3d&) { return Vector3f(0.8F, 0.6F, 0.4F); };
  const RayCaster caster(subject.mesh);
  Studio studio;
  studio.lamps.push_back({{0, 0, 20}, 0.2, Vector3f::Constant(0.8F)});
  studio.around = Vector3f::Constant(0.1F);
  studio.noise_percent = 0;
  const Camera camera = look_at({6, 0, 6}, {0, 0, 0.5}, Vector3d::UnitZ(), 120, 120, 35);
  const StudioPhoto photo = take_studio_photo(subject, caster, camera, studio);
  const auto shown = [&](const Image8& image, const Vector3d& x) {
    const Eigen::Vector2d pixel = camera.project(x).pixel;
    return static_cast<int>(image.at(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()), 1));
  };
  const Vector3d shadowed = Vector3d(0.15, 0, 1).normalized();
  const Vector3d lit = Vector3d(0.55, 0, 0.85).normalized();
  EXPECT_GT(shown(photo.image, lit), shown(photo.image, shadowed) + 60);
  EXPECT_GT(shown(photo.image, lit), shown(photo.image, {1, 0, 0}) + 60);  // the lamp grazes it
  EXPECT_EQ(shown(photo.paint, lit), 153);
  EXPECT_EQ(shown(photo.paint, shadowed), 153);
  EXPECT_EQ(photo.image.at(0, 0), 0);
  EXPECT_EQ(photo.stencil.at(0, 0), stencil::background);
  EXPECT_EQ(take_studio_photo(subject, caster, camera, studio).image, photo.image);
}

}  // namespace
}  // namespace drape::simulation
