// What a textured mesh must keep before it is written to any format.
#pragma once

#include <filesystem>

#include "drape/geometry/textured_mesh.hpp"

namespace drape::io {

/// Error{input} naming `file` if the model has no faces or breaks its promises: a vertex, face or material
/// number out of range, a texture coordinate that is not finite, an attribute of another length, an image
/// without 3 channels.
void check_model(const std::filesystem::path& file, const TexturedMesh& model);

[[nodiscard]] inline bool is_flat(const Material& material) {
  return material.image.empty();
}
/// Whether any face is painted flat: then vertex colours count.
[[nodiscard]] bool has_flat_faces(const TexturedMesh& model);

}  // namespace drape::io
