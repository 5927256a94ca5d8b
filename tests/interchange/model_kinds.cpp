#include "model_kinds.hpp"

#include <cmath>

#include "support.hpp"

namespace drape::test {
namespace {

Image8 picture(int width, int height, std::uint8_t red) {
  Image8 image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      image.at(x, y, 0) = red;
      image.at(x, y, 1) = static_cast<std::uint8_t>(x * 255 / width);
      image.at(x, y, 2) = static_cast<std::uint8_t>(y * 255 / height);
    }
  return image;
}

// A torus whose faces show one picture where x > 0, another where y > 0, and are flat elsewhere.
TexturedMesh torus_of(std::vector<Material> materials) {
  TexturedMesh model;
  model.mesh = torus(1, 0.4, 36, 18);
  model.mesh.normals = vertex_normals(model.mesh);
  model.materials = std::move(materials);
  for (const Face& face : model.mesh.faces) {
    const Eigen::Vector3d center =
        (model.mesh.vertices[face[0]] + model.mesh.vertices[face[1]] + model.mesh.vertices[face[2]]) / 3;
    const std::uint32_t wanted = center.x() > 0 ? 0 : center.y() > 0 ? 1 : 2;
    const auto m = std::min(wanted, static_cast<std::uint32_t>(model.materials.size() - 1));
    model.face_materials.push_back(m);
    auto& uvs = model.corner_uvs.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      uvs[k] =
          model.materials[m].image.empty()
              ? Eigen::Vector2f(0, 0)
              : Eigen::Vector2f((model.mesh.vertices[face[k]].head<2>().cast<float>().array() + 1.5F) / 3.0F);
  }
  return model;
}

TexturedMesh with_colors(TexturedMesh model) {
  for (const Eigen::Vector3d& v : model.mesh.vertices)
    model.mesh.colors.emplace_back(static_cast<float>(v.x() + 2) / 4, 0.2F,
                                   static_cast<float>(v.y() + 2) / 4);
  return model;
}

TexturedMesh with_bumps(TexturedMesh model) {
  for (Material& material : model.materials) {
    if (material.image.empty()) continue;
    material.normal_map = Image8(64, 64, 3, 128);
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        const double tilt = 0.5 * std::sin(x * 0.6);
        material.normal_map.at(x, y, 0) = static_cast<std::uint8_t>(std::lround(127.5 * (1 + tilt)));
        material.normal_map.at(x, y, 2) =
            static_cast<std::uint8_t>(std::lround(127.5 * (1 + std::sqrt(1 - tilt * tilt))));
      }
  }
  return model;
}

}  // namespace

std::vector<ModelKind> model_kinds() {
  const Material a{"photo_000", picture(64, 48, 20), Eigen::Vector3f::Ones()};
  const Material b{"photo_001", picture(33, 57, 220), Eigen::Vector3f::Ones()};
  const Material unseen{"unseen", {}, Eigen::Vector3f(0.6F, 0.6F, 0.6F)};
  const Material white{"unseen", {}, Eigen::Vector3f::Ones()};
  const Material surface{"surface", {}, Eigen::Vector3f(0.75F, 0.75F, 0.75F)};
  io::GlbOptions unlit;
  unlit.unlit = true;
  io::GlbOptions unlit_jpeg = unlit;
  unlit_jpeg.jpeg_textures = true;
  io::GlbOptions lit_jpeg;
  lit_jpeg.jpeg_textures = true;
  return {{"unlit_png", torus_of({a, b, unseen}), unlit},
          {"unlit_jpeg_scan_colours", with_colors(torus_of({a, b, white})), unlit_jpeg},
          {"lit_one_photo", torus_of({a}), {}},
          {"lit_normal_maps", with_bumps(torus_of({a, b, unseen})), {}},
          {"lit_jpeg_normal_maps", with_bumps(torus_of({a, unseen})), lit_jpeg},
          {"unlit_with_maps_to_leave_out", with_bumps(torus_of({a, unseen})), unlit},
          {"mesh_alone", torus_of({surface}), {}},
          {"mesh_with_colours", with_colors(torus_of({white})), {}}};
}

}  // namespace drape::test
