// A mesh with texture coordinates and the images they point into.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "drape/geometry/deep_image.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape {

/// What a group of faces is painted with: an image, or one flat colour.
struct Material {
  std::string name;  // [A-Za-z0-9_]+
  Image8 image;      // 3 channels; empty: flat colour (times vertex colours)
  Eigen::Vector3f flat_color = Eigen::Vector3f::Ones();  // as stored (sRGB-encoded), 0..1
  /// Normals in the axes of corner_tangents(), (1 + n) / 2 * 255: x along u, y against v (up in the picture),
  /// z outwards. 3 channels, the texture coordinates of `image`; empty: none.
  Image8 normal_map = {};
  /// `image` before it was reduced to 8 bits, where the model was painted in more; empty: it was not.
  Image16 deep_image = {};
};

/// Texture coordinates inside drape: u to the right, v DOWN from the top left corner, 0..1 over the image.
/// Writers of formats with a bottom-left origin flip v.
struct TexturedMesh {
  TriangleMesh mesh;
  std::vector<std::array<Eigen::Vector2f, 3>> corner_uvs;  // per face and corner; zero for a flat material
  std::vector<std::uint32_t> face_materials;               // per face: index into materials
  std::vector<Material> materials;
};

}  // namespace drape
