// glTF 2.0 binary (Khronos Group, "glTF 2.0 Specification", section 4.4 for the container).
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/geometry/tangent_frames.hpp"
#include "drape/io/model_files.hpp"
#include "drape/io/photo.hpp"
#include "model_problem.hpp"

namespace drape::io {
namespace {

using Json = nlohmann::ordered_json;

// Numbers of the specification.
constexpr int component_float = 5126, component_uint32 = 5125;
constexpr int target_vertices = 34962, target_indices = 34963;
constexpr int filter_linear = 9729, filter_linear_mipmap_linear = 9987, wrap_clamp = 33071;
constexpr std::uint32_t magic_glb = 0x46546C67, chunk_json = 0x4E4F534A, chunk_bin = 0x004E4942;

/// IEC 61966-2-1: sRGB to linear light.
float linear(float value) {
  const double s = std::isfinite(value) ? std::clamp(static_cast<double>(value), 0.0, 1.0) : 0.0;
  return static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
}

template <class Number>
void append(std::string& bytes, Number value) {
  const auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(value);
  bytes.append(raw.data(), raw.size());
}

/// One primitive: the faces of one material. A vertex is repeated only where its corners differ in (u, v).
struct Primitive {
  std::vector<std::uint32_t> vertices;    // of the mesh
  std::vector<Eigen::Vector2f> uvs;       // empty for a flat material
  std::vector<Eigen::Vector4f> tangents;  // of a material with a normal map; else empty
  std::vector<std::uint32_t> indices;
};

struct CornerKey {
  std::uint32_t vertex, u, v;
  bool operator==(const CornerKey&) const = default;
};
struct CornerHash {
  std::size_t operator()(const CornerKey& key) const {
    std::uint64_t h = key.vertex;
    for (const std::uint32_t part : {key.u, key.v}) h = (h ^ part) * 0x9E3779B97F4A7C15ULL + (h >> 29);
    return static_cast<std::size_t>(h);
  }
};

using CornerTangents = std::vector<std::array<Eigen::Vector4f, 3>>;

/// `tangents`: per face and corner; empty if no normal map is written.
std::vector<Primitive> primitives_of(const TexturedMesh& model, const CornerTangents& tangents,
                                     bool mirrored) {
  std::vector<Primitive> primitives(model.materials.size());
  std::vector<std::unordered_map<CornerKey, std::uint32_t, CornerHash>> known(model.materials.size());
  for (std::size_t f = 0; f < model.mesh.faces.size(); ++f) {
    const std::uint32_t m = model.face_materials[f];
    const bool flat = is_flat(model.materials[m]);
    const bool bumpy = !tangents.empty() && !flat && !model.materials[m].normal_map.empty();
    Primitive& primitive = primitives[m];
    for (const std::size_t k :
         mirrored ? std::array<std::size_t, 3>{0, 2, 1} : std::array<std::size_t, 3>{0, 1, 2}) {
      // + 0 makes one of the two zeros.
      const Eigen::Vector2f uv =
          flat ? Eigen::Vector2f(0, 0) : Eigen::Vector2f(model.corner_uvs[f][k].array() + 0.0F);
      const CornerKey key{model.mesh.faces[f][k], std::bit_cast<std::uint32_t>(uv.x()),
                          std::bit_cast<std::uint32_t>(uv.y())};
      const auto [entry, added] =
          known[m].try_emplace(key, static_cast<std::uint32_t>(primitive.vertices.size()));
      if (added) {
        primitive.vertices.push_back(key.vertex);
        if (!flat) primitive.uvs.push_back(uv);
        if (bumpy) primitive.tangents.push_back(tangents[f][k]);
      }
      primitive.indices.push_back(entry->second);
    }
  }
  return primitives;
}

/// The JSON and the binary chunk as they grow together.
class GlbBuilder {
 public:
  explicit GlbBuilder(const GlbOptions& options) : options_(options) {
    root_["asset"] = {{"version", "2.0"}, {"generator", "drape"}};
  }

  Json& root() { return root_; }

  int accessor_of_vectors(const std::vector<Eigen::Vector3f>& values, bool limits) {
    const int view = begin_view(target_vertices);
    for (const Eigen::Vector3f& value : values)
      for (const float x : value) append(binary_, x);
    end_view();
    Json accessor = accessor_json(view, component_float, values.size(), "VEC3");
    if (limits) {
      Eigen::Vector3f least = values.front(), most = values.front();
      for (const Eigen::Vector3f& value : values) {
        least = least.cwiseMin(value);
        most = most.cwiseMax(value);
      }
      accessor["min"] = {least.x(), least.y(), least.z()};
      accessor["max"] = {most.x(), most.y(), most.z()};
    }
    return add("accessors", std::move(accessor));
  }

  int accessor_of_uvs(const std::vector<Eigen::Vector2f>& values) {
    const int view = begin_view(target_vertices);
    for (const Eigen::Vector2f& value : values)
      for (const float x : value) append(binary_, x);
    end_view();
    return add("accessors", accessor_json(view, component_float, values.size(), "VEC2"));
  }

  int accessor_of_tangents(const std::vector<Eigen::Vector4f>& values) {
    const int view = begin_view(target_vertices);
    for (const Eigen::Vector4f& value : values)
      for (const float x : value) append(binary_, x);
    end_view();
    return add("accessors", accessor_json(view, component_float, values.size(), "VEC4"));
  }

  int accessor_of_indices(const std::vector<std::uint32_t>& values) {
    const int view = begin_view(target_indices);
    for (const std::uint32_t value : values) append(binary_, value);
    end_view();
    return add("accessors", accessor_json(view, component_uint32, values.size(), "SCALAR"));
  }

  int material(const Material& material) {
    Json pbr;
    if (is_flat(material))
      pbr["baseColorFactor"] = {linear(material.flat_color.x()), linear(material.flat_color.y()),
                                linear(material.flat_color.z()), 1.0};
    else
      pbr["baseColorTexture"] = {{"index", texture(material.image, material.name, options_.jpeg_textures)}};
    pbr["metallicFactor"] = 0;
    pbr["roughnessFactor"] = 1;
    Json json = {{"name", material.name}, {"pbrMetallicRoughness", std::move(pbr)}, {"doubleSided", true}};
    // JPEG's halved colours would tilt normals.
    if (!options_.unlit && !is_flat(material) && !material.normal_map.empty())
      json["normalTexture"] = {
          {"index", texture(material.normal_map, material.name + "_normal", false, Samples::numbers)}};
    if (options_.unlit) {
      json["extensions"] = {{"KHR_materials_unlit", Json::object()}};
      root_["extensionsUsed"] = {"KHR_materials_unlit"};
    }
    return add("materials", std::move(json));
  }

  std::string bytes(const std::string& file) {
    root_["buffers"] = {{{"byteLength", binary_.size()}}};
    std::string json = root_.dump(-1, ' ', false, Json::error_handler_t::replace);
    json.append((4 - json.size() % 4) % 4, ' ');
    binary_.append((4 - binary_.size() % 4) % 4, '\0');
    const std::uint64_t size = 12 + 8 + json.size() + 8 + binary_.size();
    if (size > std::numeric_limits<std::uint32_t>::max())
      throw io_error(
          "{}: the model takes {} bytes, more than a GLB can hold (4 GiB): simplify it or use smaller "
          "textures",
          file, size);
    std::string bytes;
    bytes.reserve(size);
    const auto word = [&](std::uint64_t value) { append(bytes, static_cast<std::uint32_t>(value)); };
    word(magic_glb);
    word(2);
    word(size);
    word(json.size());
    word(chunk_json);
    bytes += json;
    word(binary_.size());
    word(chunk_bin);
    bytes += binary_;
    return bytes;
  }

  int add(const char* list, Json value) {
    root_[list].push_back(std::move(value));
    return static_cast<int>(root_[list].size()) - 1;
  }

 private:
  int texture(const Image8& picture, const std::string& name, bool jpeg, Samples samples = Samples::srgb) {
    if (!root_.contains("samplers"))
      root_["samplers"] = {{{"magFilter", filter_linear},
                            {"minFilter", filter_linear_mipmap_linear},
                            {"wrapS", wrap_clamp},
                            {"wrapT", wrap_clamp}}};
    const int view = begin_view(0);
    binary_ += encode_image(picture, jpeg ? "jpg" : "png", options_.jpeg_quality, samples);
    end_view();
    const int image = add(
        "images", {{"name", name}, {"bufferView", view}, {"mimeType", jpeg ? "image/jpeg" : "image/png"}});
    return add("textures", {{"sampler", 0}, {"source", image}});
  }

  static Json accessor_json(int view, int component, std::size_t count, const char* type) {
    return {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}};
  }

  /// Views start at multiples of 4, which every accessor here asks for.
  int begin_view(int target) {
    binary_.append((4 - binary_.size() % 4) % 4, '\0');
    Json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", 0}};
    if (target != 0) view["target"] = target;
    return add("bufferViews", std::move(view));
  }
  void end_view() {
    Json& view = root_["bufferViews"].back();
    view["byteLength"] = binary_.size() - view["byteOffset"].get<std::size_t>();
  }

  const GlbOptions& options_;
  Json root_;
  std::string binary_;
};

std::vector<Eigen::Vector3f> positions_of(const std::filesystem::path& file, const TexturedMesh& model,
                                          const Eigen::Affine3d& transform) {
  std::vector<Eigen::Vector3f> positions;
  positions.reserve(model.mesh.vertices.size());
  for (const Eigen::Vector3d& vertex : model.mesh.vertices) {
    positions.emplace_back((transform * vertex).cast<float>());
    if (!positions.back().allFinite())
      throw input_error("{}: a vertex is too far out for a GLB's float32", file.string());
  }
  return positions;
}

std::vector<Eigen::Vector3f> normals_of(const TexturedMesh& model, const Eigen::Affine3d& transform) {
  std::vector<Eigen::Vector3f> normals =
      model.mesh.normals.empty() ? vertex_normals(model.mesh) : model.mesh.normals;
  const Eigen::Matrix3d turn = transform.linear().inverse().transpose();
  for (Eigen::Vector3f& normal : normals) {
    const Eigen::Vector3d turned = (turn * normal.cast<double>()).stableNormalized();
    // The format wants unit length; where a vertex has no face with area, any direction does.
    const bool unit = turned.allFinite() && turned.squaredNorm() > 0.5;
    normal = unit ? Eigen::Vector3f(turned.cast<float>()) : Eigen::Vector3f(0, 1, 0);
  }
  return normals;
}

/// In the file's frame; none if no material's normal map is written.
CornerTangents tangents_of(const TexturedMesh& model, const Eigen::Affine3d& transform, bool unlit) {
  if (unlit || std::all_of(model.materials.begin(), model.materials.end(),
                           [](const Material& m) { return m.normal_map.empty(); }))
    return {};
  CornerTangents tangents =
      corner_tangents(model, model.mesh.normals.empty() ? vertex_normals(model.mesh) : model.mesh.normals);
  const float turn = transform.linear().determinant() < 0 ? -1.F : 1.F;
  for (auto& corners : tangents)
    for (Eigen::Vector4f& tangent : corners) {
      const Eigen::Vector3d turned =
          (transform.linear() * tangent.head<3>().cast<double>()).stableNormalized();
      tangent << turned.cast<float>(), turn * tangent.w();
    }
  return tangents;
}

template <class Value>
std::vector<Value> chosen(const std::vector<Value>& values, const std::vector<std::uint32_t>& indices) {
  std::vector<Value> taken;
  taken.reserve(indices.size());
  for (const std::uint32_t i : indices) taken.push_back(values[i]);
  return taken;
}

}  // namespace

void write_glb(const std::filesystem::path& file, const TexturedMesh& model, const Eigen::Affine3d& transform,
               const Eigen::Vector3d& origin_in_extras, const GlbOptions& options) {
  check_model(file, model);
  const double determinant = transform.linear().determinant();
  if (!(std::abs(determinant) > 0)) throw Error(ErrorCode::bug, "the transform of a GLB cannot be inverted");
  const std::vector<Eigen::Vector3f> positions = positions_of(file, model, transform);
  const std::vector<Eigen::Vector3f> normals = normals_of(model, transform);
  std::vector<Eigen::Vector3f> colors = model.mesh.colors;
  for (Eigen::Vector3f& color : colors)
    for (float& channel : color) channel = linear(channel);

  GlbBuilder glb(options);
  glb.root()["scene"] = 0;
  glb.root()["scenes"] = {
      {{"nodes", {0}},
       {"extras", {{"origin_m", {origin_in_extras.x(), origin_in_extras.y(), origin_in_extras.z()}}}}}};
  glb.root()["nodes"] = {{{"mesh", 0}, {"name", file.stem().string()}}};
  Json list = Json::array();
  const std::vector<Primitive> primitives =
      primitives_of(model, tangents_of(model, transform, options.unlit), determinant < 0);
  for (std::size_t m = 0; m < primitives.size(); ++m) {
    const Primitive& primitive = primitives[m];
    if (primitive.indices.empty()) continue;
    Json attributes = {{"POSITION", glb.accessor_of_vectors(chosen(positions, primitive.vertices), true)},
                       {"NORMAL", glb.accessor_of_vectors(chosen(normals, primitive.vertices), false)}};
    if (!is_flat(model.materials[m]))
      attributes["TEXCOORD_0"] = glb.accessor_of_uvs(primitive.uvs);
    else if (!colors.empty())
      attributes["COLOR_0"] = glb.accessor_of_vectors(chosen(colors, primitive.vertices), false);
    if (!primitive.tangents.empty()) attributes["TANGENT"] = glb.accessor_of_tangents(primitive.tangents);
    const int indices = glb.accessor_of_indices(primitive.indices);
    list.push_back({{"attributes", std::move(attributes)},
                    {"indices", indices},
                    {"material", glb.material(model.materials[m])},
                    {"mode", 4}});
  }
  glb.root()["meshes"] = {{{"name", file.stem().string()}, {"primitives", std::move(list)}}};
  write_file(file, glb.bytes(file.string()));
}

}  // namespace drape::io
