#include "drape/texturing/normal_maps.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "drape/rendering/relit.hpp"

namespace drape::texturing {
namespace {

// A square of 2 x 2 that waves by `height`, as n x n squares.
TriangleMesh waved(int n, double height) {
  TriangleMesh mesh;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) {
      const double u = 2.0 * x / n - 1;
      const double v = 2.0 * y / n - 1;
      mesh.vertices.emplace_back(u, v, height * std::sin(9 * u) * std::cos(7 * v));
    }
  const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (n + 1) + x); };
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      mesh.faces.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
      mesh.faces.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  return mesh;
}

// White, seen from above by its texture; mirrored: u against x.
TexturedMesh white(TriangleMesh mesh, bool mirrored = false) {
  TexturedMesh model;
  model.mesh = std::move(mesh);
  model.face_materials.assign(model.mesh.faces.size(), 0);
  for (const Face& face : model.mesh.faces) {
    auto& corners = model.corner_uvs.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& x = model.mesh.vertices[face[k]];
      corners[k] = Eigen::Vector2d((mirrored ? 1 - x.x() : 1 + x.x()) / 2, (1 - x.y()) / 2).cast<float>();
    }
  }
  model.materials = {{"white", Image8(256, 256, 3, 255)}};
  return model;
}

Camera from_above() {
  Camera camera;
  camera.projection = Camera::Projection::orthographic;
  camera.width = camera.height = 80;
  camera.K << 40, 0, 40, 0, 40, 40, 0, 0, 1;
  camera.camera_from_world.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  camera.camera_from_world.translation() = Eigen::Vector3d(0, 0, 5);
  return camera;
}

double mean_difference(const Image8& a, const Image8& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.data().size(); ++i)
    sum += std::abs(static_cast<double>(a.data()[i]) - b.data()[i]);
  return sum / static_cast<double>(a.data().size());
}

TEST(NormalMaps, MakeAFlatModelLookLikeTheFullMesh) {
  const TriangleMesh full = waved(64, 0.04);
  rendering::RelitStyle style;
  style.towards_light = {0.5, 0.3, 0.8};
  style.softness_deg = 0;
  style.shadow_map_px = 256;
  const Image8 truth = render_relit(white(full), from_above(), style);
  for (const bool mirrored : {false, true}) {
    const TexturedMesh flat = white(waved(2, 0), mirrored);
    const TexturedMesh bumpy = with_normal_maps(flat, full, 128);
    EXPECT_EQ(bumpy.materials[0].normal_map.width(), 128);
    const double without = mean_difference(render_relit(flat, from_above(), style), truth);
    const double with = mean_difference(render_relit(bumpy, from_above(), style), truth);
    EXPECT_LT(with, 0.15 * without) << "mirrored " << mirrored;
  }
}

TEST(NormalMaps, OfTheMeshItselfChangeNothing) {
  const TexturedMesh model = with_normal_maps(white(waved(8, 0)), waved(8, 0), 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      EXPECT_NEAR(model.materials[0].normal_map.at(x, y, 0), 128, 1);
      EXPECT_NEAR(model.materials[0].normal_map.at(x, y, 2), 255, 1);
    }
}

}  // namespace
}  // namespace drape::texturing
