// Textured PLY as MeshLab reads it: TextureFile comments, per-face texcoord and texnumber.
#include <algorithm>
#include <cmath>

#include "drape/base/files.hpp"
#include "drape/base/numbers.hpp"
#include "drape/io/model_files.hpp"
#include "drape/io/photo.hpp"
#include "model_problem.hpp"
#include "ply_vertices.hpp"
#include "text_lines.hpp"

namespace drape::io {
namespace {

constexpr int no_texture = -1;

std::uint8_t byte_of(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255.0F));
}

// --- writing

/// Per material: its number among those with a picture, or no_texture.
std::vector<int> texture_numbers(const TexturedMesh& model) {
  std::vector<int> numbers;
  int next = 0;
  for (const Material& material : model.materials) numbers.push_back(is_flat(material) ? no_texture : next++);
  return numbers;
}

void put_materials(PlyBuilder& ply, const TexturedMesh& model,
                   const std::vector<std::string>& picture_files) {
  for (std::size_t i = 0; i < model.materials.size(); ++i)
    if (!is_flat(model.materials[i])) ply.comment("TextureFile " + picture_files[i]);
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    const Material& material = model.materials[i];
    const Eigen::Vector3f& color = material.flat_color;
    ply.obj_info(fmt::format("material {} {} {} {} {}", material.name, is_flat(material) ? "flat" : "image",
                             format_number(color.x()), format_number(color.y()), format_number(color.z())));
  }
}

void put_faces(PlyBuilder& ply, const TexturedMesh& model, bool flat_faces) {
  const std::vector<int> numbers = texture_numbers(model);
  for (std::size_t f = 0; f < model.mesh.faces.size(); ++f) {
    const std::uint32_t m = model.face_materials[f];
    ply.put_byte(3);
    for (const std::uint32_t v : model.mesh.faces[f]) ply.put_int(static_cast<std::int32_t>(v));
    ply.put_byte(6);
    for (const Eigen::Vector2f& uv : model.corner_uvs[f]) {
      ply.put_float(uv.x());
      ply.put_float(1.0F - uv.y());
    }
    ply.put_int(numbers[m]);
    if (!model.mesh.filled.empty()) ply.put_byte(model.mesh.filled[f]);
    if (!flat_faces) continue;
    ply.put_int(static_cast<std::int32_t>(m));
    // For other programs: white where the picture tells.
    const Eigen::Vector3f color =
        is_flat(model.materials[m]) ? model.materials[m].flat_color : Eigen::Vector3f(1, 1, 1);
    for (const float channel : color) ply.put_byte(byte_of(channel));
  }
}

// --- reading

struct NamedMaterials {
  std::vector<Material> materials;
  std::vector<std::string> pictures;         // per material; empty for a flat one
  std::vector<std::uint32_t> texture_owner;  // per TextureFile: its material
};

/// Names of pictures come from outside: they stay within the folder.
void check_picture_name(const std::string& file, const std::string& name) {
  const std::filesystem::path path(name);
  bool inside = !name.empty() && path.is_relative() && name.find('\\') == std::string::npos;
  for (const auto& part : path) inside = inside && part != "..";
  if (!inside) throw input_error("{}: the texture file {} does not lie beside it", file, shown(name));
}

NamedMaterials named_materials(const PlyFile& ply) {
  NamedMaterials named;
  std::vector<std::string> files;
  for (const std::string& comment : ply.header.comments) {
    Words words(comment);
    if (words.next() != "TextureFile") continue;
    files.emplace_back(words.rest());
    check_picture_name(ply.file, files.back());
  }
  std::size_t next_file = 0;
  for (const std::string& info : ply.header.obj_infos) {
    Words words(info);
    if (words.next() != "material") continue;
    Material material;
    material.name = words.next();
    const std::string_view kind = words.next();
    for (float& channel : material.flat_color) {
      const auto value = parse_value(words.next());
      if (!value) throw input_error("{}: the material line {} is damaged", ply.file, shown(info));
      channel = static_cast<float>(*value);
    }
    if (kind == "image" && next_file == files.size())
      throw input_error("{}: material {} has no TextureFile", ply.file, shown(material.name));
    if (kind == "image") named.texture_owner.push_back(static_cast<std::uint32_t>(named.materials.size()));
    named.pictures.push_back(kind == "image" ? files[next_file++] : "");
    named.materials.push_back(std::move(material));
  }
  for (; next_file < files.size(); ++next_file) {  // a file that another program wrote
    named.texture_owner.push_back(static_cast<std::uint32_t>(named.materials.size()));
    named.pictures.push_back(files[next_file]);
    named.materials.push_back({"material_" + std::to_string(next_file), {}, Eigen::Vector3f::Ones()});
  }
  if (named.materials.empty())
    throw input_error("{}: names no texture (a line \"comment TextureFile picture.png\")", ply.file);
  return named;
}

/// Whole numbers of a face's row, if the column is there.
std::optional<std::int64_t> whole_number(const PlyColumn* column, std::size_t row) {
  if (column == nullptr || column->property.list) return std::nullopt;
  const double value = column->values[row];
  if (value != std::floor(value) || std::abs(value) > 1e9) return std::int64_t{-2};
  return static_cast<std::int64_t>(value);
}

std::uint32_t material_of(const PlyFile& ply, const PlyTable& table, std::size_t row,
                          const NamedMaterials& named) {
  if (const auto own = whole_number(table.column("material_index"), row)) {
    if (*own < 0 || *own >= static_cast<std::int64_t>(named.materials.size()))
      throw ply.row_error(table, row, "the face's material is not there");
    return static_cast<std::uint32_t>(*own);
  }
  const std::int64_t texture = whole_number(table.column("texnumber"), row).value_or(0);
  if (texture < 0 || texture >= static_cast<std::int64_t>(named.texture_owner.size()))
    throw ply.row_error(table, row, "the face's texture is not there");
  return named.texture_owner[static_cast<std::size_t>(texture)];
}

void add_faces(const PlyFile& ply, const NamedMaterials& named, TexturedMesh& model) {
  const PlyTable* table = ply.table("face");
  const PlyColumn* corners =
      table == nullptr ? nullptr : table->column_of({"vertex_indices", "vertex_index"});
  const PlyColumn* uvs = table == nullptr ? nullptr : table->column("texcoord");
  if (corners == nullptr || uvs == nullptr || !corners->property.list || !uvs->property.list)
    throw input_error("{}: has no faces with vertex_indices and texcoord", ply.file);
  const PlyColumn* filled = table->column("filled");
  for (std::size_t row = 0; row < table->rows(); ++row) {
    const auto polygon = corners->row(row);
    const auto uv = uvs->row(row);
    if (uv.size() != 2 * polygon.size())
      throw ply.row_error(
          *table, row,
          fmt::format("the face has {} corners, but {} texture coordinates", polygon.size(), uv.size()));
    if (!std::all_of(uv.begin(), uv.end(), [](double x) { return std::isfinite(x); }))
      throw ply.row_error(*table, row, "the face has a texture coordinate that is not finite");
    const auto corner_uv = [&](std::size_t k) {
      return Eigen::Vector2f(static_cast<float>(uv[2 * k]), 1.0F - static_cast<float>(uv[2 * k + 1]));
    };
    for (std::size_t k = 2; k < polygon.size(); ++k) {
      model.mesh.faces.push_back({static_cast<std::uint32_t>(polygon[0]),
                                  static_cast<std::uint32_t>(polygon[k - 1]),
                                  static_cast<std::uint32_t>(polygon[k])});
      model.corner_uvs.push_back({corner_uv(0), corner_uv(k - 1), corner_uv(k)});
      model.face_materials.push_back(material_of(ply, *table, row, named));
      if (filled != nullptr && !filled->property.list)
        model.mesh.filled.push_back(filled->values[row] != 0 ? 1 : 0);
    }
  }
}

std::vector<PlyWanted> model_columns() {
  std::vector<PlyWanted> wanted = vertex_columns();
  wanted.push_back({"face", "vertex_indices", "vertex"});
  wanted.push_back({"face", "vertex_index", "vertex"});
  for (const char* name : {"texcoord", "texnumber", "material_index", "filled"})
    wanted.push_back({"face", name});
  return wanted;
}

}  // namespace

void write_textured_ply(const std::filesystem::path& file, const TexturedMesh& model,
                        const std::vector<std::string>& picture_files) {
  check_model(file, model);
  if (picture_files.size() != model.materials.size())
    throw Error(ErrorCode::bug, "a textured PLY needs one picture name per material");
  for (std::size_t i = 0; i < picture_files.size(); ++i)
    if (!is_flat(model.materials[i])) check_picture_name(file.string(), picture_files[i]);
  const bool flat_faces = has_flat_faces(model);
  TriangleMesh mesh = model.mesh;
  if (!flat_faces) mesh.colors.clear();
  PlyBuilder ply;
  put_mark(ply, "textured_mesh");
  put_materials(ply, model, picture_files);
  const VertexWriter vertices(mesh);
  vertices.declare(ply);
  ply.element("face", mesh.faces.size());
  ply.list_property(PlyType::uint8, PlyType::int32, "vertex_indices");
  ply.list_property(PlyType::uint8, PlyType::float32, "texcoord");
  ply.property(PlyType::int32, "texnumber");
  if (!mesh.filled.empty()) ply.property(PlyType::uint8, "filled");
  if (flat_faces) {
    ply.property(PlyType::int32, "material_index");
    for (const char* name : {"red", "green", "blue"}) ply.property(PlyType::uint8, name);
  }
  ply.end_header(vertices.bytes() + 50 * mesh.faces.size());
  vertices.put_rows(ply);
  put_faces(ply, model, flat_faces);
  write_file(file, ply.bytes());
}

TexturedMesh read_textured_ply(const std::filesystem::path& file,
                               const std::filesystem::path& picture_folder) {
  const PlyFile ply = read_ply(file, model_columns());
  PointCloud cloud = vertices_of(ply);
  NamedMaterials named = named_materials(ply);
  TexturedMesh model;
  model.mesh.vertices = std::move(cloud.positions);
  model.mesh.normals = std::move(cloud.normals);
  model.mesh.colors = std::move(cloud.colors);
  model.mesh.intensities = std::move(cloud.intensities);
  model.mesh.confidences = std::move(cloud.confidences);
  add_faces(ply, named, model);
  const std::filesystem::path folder = picture_folder.empty() ? file.parent_path() : picture_folder;
  for (std::size_t i = 0; i < named.materials.size(); ++i)
    if (!named.pictures[i].empty()) {
      Photo picture = read_photo(folder / named.pictures[i], true);
      named.materials[i].image = std::move(picture.rgb);
      named.materials[i].deep_image = std::move(picture.deep_rgb);
    }
  model.materials = std::move(named.materials);
  if (const std::string problem = problem_of(model.mesh); !problem.empty())
    throw input_error("{}: {}", file.string(), problem);
  return model;
}

}  // namespace drape::io
