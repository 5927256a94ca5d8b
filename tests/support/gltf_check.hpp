// A strict reader of GLB files for tests, written from the specification and not from the writer.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace drape::test {

/// Everything in which a file breaks the rules of glTF 2.0's binary form (Khronos Group, "glTF 2.0
/// Specification") as far as a static textured model goes: chunks, alignment, accessor and view bounds,
/// POSITION limits to the bit, index ranges, finite values, unit normals, materials, samplers, image
/// signatures, extensions. Empty for a good file.
[[nodiscard]] std::vector<std::string> gltf_problems(const std::filesystem::path& file);

/// The triangles of one primitive as they are in the file. Empty where it has no such attribute.
struct GltfPrimitive {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;
  std::vector<Eigen::Vector3f> colors;
  std::vector<Eigen::Vector4f> tangents;
  std::vector<Eigen::Vector2f> uvs;
  std::vector<std::uint32_t> indices;
  std::string material;
  Eigen::Vector4f base_color = Eigen::Vector4f::Ones();
  std::string image;       // its bytes; empty without a texture
  std::string normal_map;  // the same
  bool unlit = false;
};
struct GltfModel {
  std::vector<GltfPrimitive> primitives;
  std::vector<double> origin;  // of the scene's extras
};
/// Of a file without problems.
[[nodiscard]] GltfModel read_gltf(const std::filesystem::path& file);

}  // namespace drape::test
