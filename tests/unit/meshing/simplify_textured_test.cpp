#include <gtest/gtest.h>

#include <map>
#include <set>

#include "drape/meshing/simplify.hpp"
#include "support.hpp"

namespace drape::meshing {
namespace {

// A sphere that a camera far above paints from the top half, with a flat material below; each hemisphere in
// two charts, so that there are seams within a material as well.
TexturedMesh painted_sphere() {
  TexturedMesh model;
  model.mesh = test::sphere(1, 40);
  model.materials.resize(2);
  model.materials[0].name = "photo";
  model.materials[0].image = Image8(8, 8, 3);
  model.materials[1].name = "unseen";
  for (const Face& f : model.mesh.faces) {
    const Eigen::Vector3d middle =
        (model.mesh.vertices[f[0]] + model.mesh.vertices[f[1]] + model.mesh.vertices[f[2]]) / 3;
    const bool seen = middle.z() > 0;
    model.face_materials.push_back(seen ? 0 : 1);
    std::array<Eigen::Vector2f, 3> uvs;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& x = model.mesh.vertices[f[k]];
      const double chart = middle.x() > 0 ? 0.5 : 0;
      uvs[k] = seen ? Eigen::Vector2d(chart + 0.2 + 0.2 * x.x(), 0.5 + 0.4 * x.y()).cast<float>().eval()
                    : Eigen::Vector2f::Zero().eval();
    }
    model.corner_uvs.push_back(uvs);
  }
  return model;
}

std::size_t open_edges(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Face& f : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax(f[k], f[(k + 1) % 3])];
  std::size_t open = 0;
  for (const auto& [edge, count] : edges) open += count == 1 ? 1 : 0;
  return open;
}

TEST(SimplifyTextured, KeepsMaterialsCoordinatesAndSeams) {
  const TexturedMesh model = painted_sphere();
  const TexturedMesh light = simplified(model, 800);
  ASSERT_EQ(problem_of(light.mesh), "");
  EXPECT_LE(light.mesh.faces.size(), 900U);
  EXPECT_GE(light.mesh.faces.size(), 600U);
  ASSERT_EQ(light.face_materials.size(), light.mesh.faces.size());
  ASSERT_EQ(light.corner_uvs.size(), light.mesh.faces.size());
  EXPECT_EQ(light.materials.size(), 2U);
  EXPECT_EQ(open_edges(light.mesh), 0U);
  std::array<double, 2> area{};
  std::array<double, 2> area_before{};
  for (std::size_t f = 0; f < model.mesh.faces.size(); ++f)
    area_before[model.face_materials[f]] += scaled_face_normal(model.mesh, f).norm() / 2;
  for (std::size_t f = 0; f < light.mesh.faces.size(); ++f) {
    area[light.face_materials[f]] += scaled_face_normal(light.mesh, f).norm() / 2;
    if (light.face_materials[f] == 1) continue;
    // The photo's coordinates are a function of the place, up to the chart.
    std::set<float> charts;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& x = light.mesh.vertices[light.mesh.faces[f][k]];
      const Eigen::Vector2f& uv = light.corner_uvs[f][k];
      EXPECT_NEAR(uv.y(), 0.5 + 0.4 * x.y(), 1e-5);
      charts.insert(std::round(4 * (uv.x() - 0.2F - 0.2F * static_cast<float>(x.x()))) / 4);
    }
    EXPECT_EQ(charts.size(), 1U) << "a face across a seam";
  }
  for (std::size_t m = 0; m < 2; ++m) EXPECT_NEAR(area[m] / area_before[m], 1, 0.05);
}

TEST(SimplifyTextured, LeavesSmallModelsAsTheyAre) {
  const TexturedMesh model = painted_sphere();
  EXPECT_EQ(simplified(model, 0).mesh.faces, model.mesh.faces);
  EXPECT_EQ(simplified(model, 1'000'000).mesh.faces, model.mesh.faces);
}

}  // namespace
}  // namespace drape::meshing
