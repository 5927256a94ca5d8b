#include <algorithm>
#include <cmath>
#include <vector>

#include "drape/io/model_files.hpp"
#include "model_problem.hpp"

namespace drape::io {
namespace {

// IEC 61966-2-1.
float linear(float stored) {
  return stored <= 0.04045F ? stored / 12.92F : std::pow((stored + 0.055F) / 1.055F, 2.4F);
}
float stored(float light) {
  return light <= 0.0031308F ? 12.92F * light : 1.055F * std::pow(light, 1 / 2.4F) - 0.055F;
}

Eigen::Vector3f nearest_texel(const Image8& image, const Eigen::Vector2f& uv) {
  const auto at = [](float share, int size) {
    return std::clamp(static_cast<int>(share * static_cast<float>(size)), 0, size - 1);
  };
  const int x = at(uv.x(), image.width());
  const int y = at(uv.y(), image.height());
  return Eigen::Vector3f(image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)) / 255.F;
}

}  // namespace

TriangleMesh with_vertex_colors(const TexturedMesh& model) {
  TriangleMesh mesh = model.mesh;
  std::vector<Eigen::Vector4f> sums(mesh.vertices.size(), Eigen::Vector4f::Zero());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Material& material = model.materials[model.face_materials[f]];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.faces[f][k];
      Eigen::Vector3f light;
      if (!is_flat(material)) {
        light = nearest_texel(material.image, model.corner_uvs[f][k]).unaryExpr(&linear);
      } else {
        light = material.flat_color.unaryExpr(&linear);
        if (!model.mesh.colors.empty()) light = light.cwiseProduct(model.mesh.colors[v].unaryExpr(&linear));
      }
      sums[v].head<3>() += light;
      sums[v].w() += 1;
    }
  }
  mesh.colors.clear();
  for (const Eigen::Vector4f& sum : sums) {
    const Eigen::Vector3f light = sum.head<3>() / std::max(1.F, sum.w());
    mesh.colors.emplace_back(light.unaryExpr(&stored));
  }
  return mesh;
}

}  // namespace drape::io
