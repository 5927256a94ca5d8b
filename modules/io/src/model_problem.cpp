#include "model_problem.hpp"

#include <algorithm>

#include "drape/base/error.hpp"
#include "drape/io/model_files.hpp"
#include "drape/io/photo.hpp"

namespace drape::io {
namespace {

std::string problem_of_model(const TexturedMesh& model) {
  if (model.mesh.faces.empty()) return "the model has no faces";
  if (std::string problem = problem_of(model.mesh); !problem.empty()) return problem;
  if (model.corner_uvs.size() != model.mesh.faces.size())
    return "the texture coordinates are not one set per face";
  if (model.face_materials.size() != model.mesh.faces.size()) return "the materials are not one per face";
  for (std::size_t i = 0; i < model.face_materials.size(); ++i) {
    if (model.face_materials[i] >= model.materials.size())
      return fmt::format("face {} has a material that is not there", i);
    for (const Eigen::Vector2f& uv : model.corner_uvs[i])
      if (!uv.allFinite()) return fmt::format("face {} has a texture coordinate that is not finite", i);
  }
  for (const Material& material : model.materials) {
    if (material.name.empty() || !std::all_of(material.name.begin(), material.name.end(), [](char c) {
          return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
        }))
      return fmt::format("a material has the name \"{}\"", material.name);
    if (std::count_if(model.materials.begin(), model.materials.end(),
                      [&](const Material& m) { return m.name == material.name; }) > 1)
      return fmt::format("two materials have the name \"{}\"", material.name);
    if (!material.image.empty() && material.image.channels() != 3)
      return fmt::format("the image of material \"{}\" is not RGB", material.name);
    if (!material.flat_color.allFinite())
      return fmt::format("the colour of material \"{}\" is not finite", material.name);
  }
  return {};
}

}  // namespace

void check_model(const std::filesystem::path& file, const TexturedMesh& model) {
  if (const std::string problem = problem_of_model(model); !problem.empty())
    throw input_error("{}: cannot be written: {}", file.string(), problem);
}

bool has_flat_faces(const TexturedMesh& model) {
  return std::any_of(model.face_materials.begin(), model.face_materials.end(),
                     [&](std::uint32_t m) { return is_flat(model.materials[m]); });
}

std::string picture_name(const Material& material) {
  if (is_flat(material)) return {};
  return material.name + (material.deep_image.empty() ? ".png" : ".tif");
}

void write_picture(const std::filesystem::path& file, const Material& material) {
  if (material.deep_image.empty())
    write_image(file, material.image);
  else
    write_tiff(file, material.deep_image);
}

}  // namespace drape::io
