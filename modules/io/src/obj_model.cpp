// Wavefront OBJ with its MTL and pictures.
#include <bit>
#include <charconv>
#include <unordered_map>

#include "drape/base/files.hpp"
#include "drape/base/numbers.hpp"
#include "drape/io/model_files.hpp"
#include "drape/io/photo.hpp"
#include "model_problem.hpp"

namespace drape::io {
namespace {

/// `mtllib` and `map_Kd` take several names with blanks between them, so a name of ours has none.
std::string name_without_blanks(std::string name) {
  for (char& c : name)
    if (c == ' ' || c == '\t' || c == '#' || c == '\n' || c == '\r') c = '_';
  return name;
}

template <class Number>
void put(std::string& text, Number value) {
  char buffer[32];
  const auto [end, problem] = std::to_chars(buffer, buffer + sizeof buffer, value);
  text.append(buffer, end);
}

template <class Vector>
void put_line(std::string& text, std::string_view key, const Vector& values) {
  text += key;
  for (const auto value : values) {
    text += ' ';
    put(text, value);
  }
}

std::string mtl_text(const TexturedMesh& model, const std::vector<std::string>& pictures) {
  std::string text;
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    const Material& material = model.materials[i];
    text += "newmtl " + material.name + "\nKa 0 0 0\n";
    put_line(text, "Kd", is_flat(material) ? material.flat_color : Eigen::Vector3f(1, 1, 1));
    text += "\nKs 0 0 0\nd 1\nillum 1\n";
    if (!pictures[i].empty()) text += "map_Kd " + pictures[i] + "\n";
    text += "\n";
  }
  return text;
}

/// Texture coordinates, each pair once.
class UvTable {
 public:
  explicit UvTable(std::string& text) : text_(text) {}

  /// The number of the pair, counted from 1; writes it if it is new. v is flipped to the bottom-left origin
  /// here.
  std::size_t number(const Eigen::Vector2f& uv) {
    const std::uint64_t key =
        std::uint64_t{std::bit_cast<std::uint32_t>(uv.x())} << 32 | std::bit_cast<std::uint32_t>(uv.y());
    const auto [entry, added] = numbers_.try_emplace(key, numbers_.size() + 1);
    if (added) {
      put_line(text_, "vt", Eigen::Vector2d(uv.x(), 1.0 - static_cast<double>(uv.y())));
      text_ += '\n';
    }
    return entry->second;
  }

 private:
  std::string& text_;
  std::unordered_map<std::uint64_t, std::size_t> numbers_;
};

void put_vertices(std::string& text, const TriangleMesh& mesh, bool colors) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    put_line(text, "v", mesh.vertices[i]);
    if (colors) put_line(text, "", mesh.colors[i]);
    text += '\n';
  }
  for (const Eigen::Vector3f& normal : mesh.normals) {
    put_line(text, "vn", normal);
    text += '\n';
  }
}

void put_faces(std::string& text, const TexturedMesh& model, std::size_t material, UvTable& uvs) {
  const bool flat = is_flat(model.materials[material]);
  const bool normals = !model.mesh.normals.empty();
  text += "usemtl " + model.materials[material].name + "\n";
  for (std::size_t f = 0; f < model.mesh.faces.size(); ++f) {
    if (model.face_materials[f] != material) continue;
    std::size_t vt[3] = {};
    for (std::size_t k = 0; k < 3 && !flat; ++k) vt[k] = uvs.number(model.corner_uvs[f][k]);
    text += 'f';
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t v = std::uint64_t{model.mesh.faces[f][k]} + 1;
      text += ' ';
      put(text, v);
      if (flat && !normals) continue;
      text += '/';
      if (!flat) put(text, vt[k]);
      if (!normals) continue;
      text += '/';
      put(text, v);
    }
    text += '\n';
  }
}

}  // namespace

std::vector<std::filesystem::path> write_obj(const std::filesystem::path& file, const TexturedMesh& model) {
  check_model(file, model);
  const std::string stem = name_without_blanks(file.stem().string());
  const std::filesystem::path folder = file.parent_path();
  std::vector<std::filesystem::path> written{file, folder / (stem + ".mtl")};
  // The OBJ comes last: it is there only when everything that it names is.
  std::vector<std::string> pictures;
  for (const Material& material : model.materials) {
    pictures.push_back(is_flat(material) ? "" : stem + "_" + picture_name(material));
    if (is_flat(material)) continue;
    written.push_back(folder / pictures.back());
    write_picture(written.back(), material);
  }
  write_file(written[1], mtl_text(model, pictures));

  std::string text = "# drape\nmtllib " + stem + ".mtl\n";
  put_vertices(text, model.mesh, !model.mesh.colors.empty() && has_flat_faces(model));
  UvTable uvs(text);
  std::vector<bool> used(model.materials.size());
  for (const std::uint32_t m : model.face_materials) used[m] = true;
  for (std::size_t m = 0; m < model.materials.size(); ++m)
    if (used[m]) put_faces(text, model, m, uvs);
  write_file(file, text);
  return written;
}

}  // namespace drape::io
