#include "gltf_check.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

namespace drape::test {
namespace {

using Json = nlohmann::json;

/// Stops the check where nothing further can be looked at.
struct Stop {};

class Checker {
 public:
  explicit Checker(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) {
      problem("{}: cannot be opened", file.string());
      return;
    }
    bytes_.assign(std::istreambuf_iterator<char>(stream), {});
  }

  std::vector<std::string> check() {
    if (!problems_.empty()) return problems_;
    try {
      container();
      if (json_.value("asset", Json::object()).value("version", "") != "2.0")
        problem("asset.version is not 2.0");
      top_level();
      buffer();
      for (std::size_t i = 0; i < list("bufferViews").size(); ++i) view(i);
      for (std::size_t i = 0; i < list("accessors").size(); ++i) accessor(i);
      for (std::size_t i = 0; i < list("images").size(); ++i) image(i);
      for (const Json& sampler : list("samplers")) this->sampler(sampler);
      for (const Json& texture : list("textures")) this->texture(texture);
      for (std::size_t i = 0; i < list("materials").size(); ++i) material(i);
      for (const Json& mesh : list("meshes")) this->mesh(mesh);
      scenes();
    } catch (const Stop&) {
    } catch (const Json::exception& wrong) {
      problem("a member has the wrong type: {}", wrong.what());
    }
    return problems_;
  }

  GltfModel read() {
    container();
    GltfModel model;
    if (const Json& extras = json_["scenes"][0].value("extras", Json::object()); extras.contains("origin_m"))
      model.origin = extras["origin_m"].get<std::vector<double>>();
    for (const Json& mesh : list("meshes"))
      for (const Json& primitive : mesh["primitives"]) model.primitives.push_back(read_primitive(primitive));
    return model;
  }

 private:
  template <class... Args>
  void problem(fmt::format_string<Args...> format, Args&&... args) {
    problems_.push_back(fmt::format(format, std::forward<Args>(args)...));
  }
  template <class... Args>
  [[noreturn]] void stop(fmt::format_string<Args...> format, Args&&... args) {
    problems_.push_back(fmt::format(format, std::forward<Args>(args)...));
    throw Stop{};
  }

  template <class Number>
  Number load(std::size_t at) const {
    Number number;
    std::memcpy(&number, bytes_.data() + at, sizeof number);
    return number;
  }

  const Json& list(const char* name) const {
    static const Json nothing = Json::array();
    return json_.contains(name) ? json_[name] : nothing;
  }
  /// The number of something in a list, or nothing (and a problem).
  std::optional<std::size_t> index(const Json& value, const char* name) {
    if (value.is_number_unsigned() && value.get<std::size_t>() < list(name).size())
      return value.get<std::size_t>();
    problem("{} names none of the {}", value.dump(), name);
    return std::nullopt;
  }

  // --- section 4.4: header, a JSON chunk padded with blanks, a binary chunk padded with zeros

  void container() {
    if (bytes_.size() < 20) stop("shorter than a GLB header");
    if (bytes_.compare(0, 4, "glTF") != 0) stop("the magic is not glTF");
    if (load<std::uint32_t>(4) != 2) stop("the container version is not 2");
    if (load<std::uint32_t>(8) != bytes_.size())
      stop("the length {} is not the file's size {}", load<std::uint32_t>(8), bytes_.size());
    const std::size_t json_size = load<std::uint32_t>(12);
    if (bytes_.compare(16, 4, "JSON") != 0) stop("the first chunk is not JSON");
    if (json_size % 4 != 0) stop("the JSON chunk's length {} is no multiple of 4", json_size);
    if (json_size > bytes_.size() - 20) stop("the JSON chunk is longer than the file");
    const std::string text = bytes_.substr(20, json_size);
    json_ = Json::parse(text, nullptr, false);
    if (json_.is_discarded() || !json_.is_object()) stop("the JSON chunk is no JSON object");
    if (text.empty() || text.front() != '{' || text.find_last_not_of(' ') != text.rfind('}'))
      problem("the JSON chunk is not padded with blanks");
    const std::size_t at = 20 + json_size;
    if (at == bytes_.size()) return;
    if (bytes_.size() - at < 8) stop("the header of the binary chunk is cut");
    binary_size_ = load<std::uint32_t>(at);
    if (bytes_.compare(at + 4, 4, std::string("BIN\0", 4)) != 0) stop("the second chunk is not binary");
    if (binary_size_ % 4 != 0) problem("the binary chunk's length {} is no multiple of 4", binary_size_);
    if (binary_size_ != bytes_.size() - at - 8) stop("the chunks do not fill the file");
    binary_ = at + 8;
  }

  void top_level() {
    static const std::set<std::string> known{
        "asset",      "scene",     "scenes",   "nodes",  "meshes",   "accessors",      "bufferViews",
        "buffers",    "materials", "textures", "images", "samplers", "extensionsUsed", "extensionsRequired",
        "extensions", "extras"};
    for (const auto& [name, value] : json_.items()) {
      if (known.count(name) == 0) problem("unexpected member {}", name);
      if (value.is_array() && value.empty()) problem("the list {} is empty", name);
    }
    for (const Json& name : list("extensionsUsed")) used_.insert(name.get<std::string>());
    for (const std::string& name : used_)
      if (name != "KHR_materials_unlit") problem("unknown extension {}", name);
    for (const Json& name : list("extensionsRequired"))
      if (used_.count(name.get<std::string>()) == 0) problem("a required extension is not listed as used");
  }

  void buffer() {
    const Json& buffers = list("buffers");
    if (buffers.size() != 1) stop("{} buffers instead of 1", buffers.size());
    if (buffers[0].contains("uri")) problem("the buffer has a uri");
    buffer_size_ = buffers[0].at("byteLength").get<std::size_t>();
    if (buffer_size_ == 0 || buffer_size_ > binary_size_ || binary_size_ - buffer_size_ > 3)
      stop("the buffer has {} bytes, the binary chunk {}", buffer_size_, binary_size_);
    for (std::size_t i = buffer_size_; i < binary_size_; ++i)
      if (bytes_[binary_ + i] != 0) problem("the binary chunk is not padded with zeros");
  }

  // --- views and accessors (sections 3.6.1, 3.6.2)

  void view(std::size_t i) {
    const Json& view = list("bufferViews")[i];
    if (view.at("buffer") != 0) stop("view {} has no buffer", i);
    const std::size_t offset = view.value("byteOffset", std::size_t{0});
    const std::size_t length = view.at("byteLength").get<std::size_t>();
    if (length == 0 || offset > buffer_size_ || length > buffer_size_ - offset)
      stop("view {} reaches beyond the buffer", i);
    if (view.contains("target") && view["target"] != 34962 && view["target"] != 34963)
      problem("view {} has an unknown target", i);
    if (view.contains("byteStride"))
      problem("view {} has a stride, which only interleaved attributes need", i);
  }

  static std::size_t component_size(const Json& accessor) {
    switch (accessor.at("componentType").get<int>()) {
      case 5120:
      case 5121:
        return 1;
      case 5122:
      case 5123:
        return 2;
      case 5125:
      case 5126:
        return 4;
      default:
        return 0;
    }
  }
  static std::size_t components(const Json& accessor) {
    const std::string type = accessor.at("type").get<std::string>();
    return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 0;
  }
  std::size_t start(const Json& accessor) const {
    const Json& view = list("bufferViews")[accessor.at("bufferView").get<std::size_t>()];
    return binary_ + view.value("byteOffset", std::size_t{0}) + accessor.value("byteOffset", std::size_t{0});
  }

  void accessor(std::size_t i) {
    const Json& accessor = list("accessors")[i];
    const auto view = index(accessor.at("bufferView"), "bufferViews");
    const std::size_t size = component_size(accessor);
    const std::size_t count = accessor.at("count").get<std::size_t>();
    if (!view || size == 0 || components(accessor) == 0 || count == 0) stop("accessor {} makes no sense", i);
    const std::size_t offset = accessor.value("byteOffset", std::size_t{0});
    const std::size_t length = list("bufferViews")[*view].at("byteLength").get<std::size_t>();
    if (offset > length || count > (length - offset) / (size * components(accessor)))
      stop("accessor {} reaches beyond its view", i);
    if (offset % size != 0 || (start(accessor) - binary_) % size != 0)
      problem("accessor {} is not aligned to its components", i);
    if (accessor.at("componentType") == 5126)
      for (const float value : floats(accessor))
        if (!std::isfinite(value)) {
          problem("accessor {} holds a value that is not finite", i);
          break;
        }
    if (accessor.contains("min") || accessor.contains("max")) limits(i, accessor);
  }

  std::vector<float> floats(const Json& accessor) const {
    std::vector<float> values(accessor.at("count").get<std::size_t>() * components(accessor));
    std::memcpy(values.data(), bytes_.data() + start(accessor), values.size() * sizeof(float));
    return values;
  }

  void limits(std::size_t i, const Json& accessor) {
    if (accessor.at("componentType") != 5126)
      return problem("accessor {} has limits that are not checked here", i);
    const std::size_t n = components(accessor);
    const std::vector<float> values = floats(accessor);
    const Json& least = accessor.at("min");
    const Json& most = accessor.at("max");
    if (least.size() != n || most.size() != n) return problem("accessor {} has limits of another size", i);
    for (std::size_t k = 0; k < n; ++k) {
      float low = values[k], high = values[k];
      for (std::size_t j = k; j < values.size(); j += n) {
        low = std::min(low, values[j]);
        high = std::max(high, values[j]);
      }
      if (least[k].get<float>() != low || most[k].get<float>() != high)
        problem("accessor {} has limits that are not its values'", i);
    }
  }

  // --- images, samplers, textures, materials (sections 3.8, 3.9)

  void image(std::size_t i) {
    const Json& image = list("images")[i];
    if (image.contains("uri")) return problem("image {} lies outside of the file", i);
    const auto view = index(image.at("bufferView"), "bufferViews");
    if (!view) return;
    if (list("bufferViews")[*view].contains("target")) problem("the view of image {} has a target", i);
    const std::string bytes = image_bytes(i);
    const std::string type = image.at("mimeType").get<std::string>();
    const bool png = type == "image/png" && bytes.compare(0, 8, "\x89PNG\r\n\x1A\n") == 0;
    const bool jpeg = type == "image/jpeg" && bytes.compare(0, 3, "\xFF\xD8\xFF") == 0;
    if (!png && !jpeg) problem("image {} is not the {} that it says", i, type);
  }

  std::string image_bytes(std::size_t i) const {
    const Json& view = list("bufferViews")[list("images")[i].at("bufferView").get<std::size_t>()];
    return bytes_.substr(binary_ + view.value("byteOffset", std::size_t{0}),
                         view.at("byteLength").get<std::size_t>());
  }

  void sampler(const Json& sampler) {
    static const std::set<int> magnifying{9728, 9729}, minifying{9728, 9729, 9984, 9985, 9986, 9987},
        wrapping{33071, 33648, 10497};
    if (magnifying.count(sampler.value("magFilter", 9729)) == 0 ||
        minifying.count(sampler.value("minFilter", 9987)) == 0 ||
        wrapping.count(sampler.value("wrapS", 10497)) == 0 ||
        wrapping.count(sampler.value("wrapT", 10497)) == 0)
      problem("a sampler has an unknown filter or wrapping");
  }

  void texture(const Json& texture) {
    if (texture.contains("sampler")) (void)index(texture["sampler"], "samplers");
    (void)index(texture.at("source"), "images");
  }

  void material(std::size_t i) {
    const Json& material = list("materials")[i];
    const Json pbr = material.value("pbrMetallicRoughness", Json::object());
    const auto in_unit = [](const Json& value) { return value.is_number() && value >= 0 && value <= 1; };
    for (const char* name : {"metallicFactor", "roughnessFactor"})
      if (pbr.contains(name) && !in_unit(pbr[name]))
        problem("material {}: {} is not within 0 and 1", i, name);
    if (pbr.contains("baseColorFactor")) {
      const Json& factor = pbr["baseColorFactor"];
      if (factor.size() != 4 || !std::all_of(factor.begin(), factor.end(), in_unit))
        problem("material {}: baseColorFactor is no colour", i);
    }
    if (pbr.contains("baseColorTexture")) (void)index(pbr["baseColorTexture"].at("index"), "textures");
    if (material.contains("normalTexture")) (void)index(material["normalTexture"].at("index"), "textures");
    const Json extensions = material.value("extensions", Json::object());
    for (const auto& [name, value] : extensions.items())
      if (used_.count(name) == 0 || !value.is_object())
        problem("material {}: extension {} is not listed as used", i, name);
  }

  // --- meshes and scenes (sections 3.7, 3.5)

  void mesh(const Json& mesh) {
    if (mesh.at("primitives").empty()) problem("a mesh has no primitives");
    for (const Json& primitive : mesh["primitives"]) this->primitive(primitive);
  }

  const Json* attribute(const Json& primitive, const char* name, std::size_t components_wanted,
                        std::size_t count) {
    if (!primitive.at("attributes").contains(name)) return nullptr;
    const auto i = index(primitive["attributes"][name], "accessors");
    if (!i) throw Stop{};
    const Json& accessor = list("accessors")[*i];
    if (accessor.at("componentType") != 5126 || components(accessor) != components_wanted)
      stop("{} is no VEC{} of floats", name, components_wanted);
    if (count != 0 && accessor.at("count") != count) stop("{} has another count than POSITION", name);
    if ((start(accessor) - binary_) % 4 != 0) problem("{} does not start at a multiple of 4", name);
    const Json& view = list("bufferViews")[accessor["bufferView"].get<std::size_t>()];
    if (view.value("target", 34962) != 34962) problem("{} lies in a view of indices", name);
    return &accessor;
  }

  void primitive(const Json& primitive) {
    if (primitive.value("mode", 4) != 4) problem("a primitive is no list of triangles");
    const Json* positions = attribute(primitive, "POSITION", 3, 0);
    if (positions == nullptr) stop("a primitive has no POSITION");
    if (!positions->contains("min") || !positions->contains("max")) problem("POSITION has no limits");
    const std::size_t count = positions->at("count").get<std::size_t>();
    if (const Json* normals = attribute(primitive, "NORMAL", 3, count)) unit_length(floats(*normals));
    if (const Json* colors = attribute(primitive, "COLOR_0", 3, count))
      for (const float value : floats(*colors))
        if (!(value >= 0 && value <= 1)) {
          problem("COLOR_0 is not within 0 and 1");
          break;
        }
    const Json* tangents = attribute(primitive, "TANGENT", 4, count);
    if (tangents != nullptr) this->tangents(floats(*tangents));
    const bool uvs = attribute(primitive, "TEXCOORD_0", 2, count) != nullptr;
    for (const auto& [name, value] : primitive.at("attributes").items())
      if (name != "POSITION" && name != "NORMAL" && name != "COLOR_0" && name != "TEXCOORD_0" &&
          name != "TANGENT")
        problem("unexpected attribute {}", name);
    if (primitive.contains("indices"))
      indices(primitive["indices"], count);
    else if (count % 3 != 0)
      problem("the vertices make no whole triangles");
    if (!primitive.contains("material")) return;
    const auto m = index(primitive["material"], "materials");
    if (m && !uvs &&
        list("materials")[*m].value("pbrMetallicRoughness", Json::object()).contains("baseColorTexture"))
      problem("a textured primitive has no TEXCOORD_0");
    if (m && !uvs && list("materials")[*m].contains("normalTexture"))
      problem("a primitive with a normal map has no TEXCOORD_0");
  }

  void tangents(const std::vector<float>& values) {
    for (std::size_t i = 0; i + 3 < values.size(); i += 4) {
      const float length = std::hypot(values[i], values[i + 1], values[i + 2]);
      if (std::abs(length - 1) > 5e-4F) return problem("a tangent has length {}", length);
      if (std::abs(values[i + 3]) != 1) return problem("a tangent's w is {}", values[i + 3]);
    }
  }

  void unit_length(const std::vector<float>& values) {
    for (std::size_t i = 0; i + 2 < values.size(); i += 3)
      if (const float length = std::hypot(values[i], values[i + 1], values[i + 2]);
          std::abs(length - 1) > 5e-4F)
        return problem("a normal has length {}", length);
  }

  void indices(const Json& value, std::size_t vertices) {
    const auto i = index(value, "accessors");
    if (!i) return;
    const Json& accessor = list("accessors")[*i];
    if (components(accessor) != 1 || accessor.at("componentType") != 5125)
      return problem("the indices are no unsigned 32-bit scalars");
    if (accessor.at("count").get<std::size_t>() % 3 != 0) problem("the indices make no whole triangles");
    const Json& view = list("bufferViews")[accessor["bufferView"].get<std::size_t>()];
    if (view.value("target", 34963) != 34963) problem("the indices lie in a view of vertices");
    for (const std::uint32_t vertex : index_values(accessor))
      if (vertex >= vertices)
        return problem("index {} is out of range: there are {} vertices", vertex, vertices);
  }

  std::vector<std::uint32_t> index_values(const Json& accessor) const {
    std::vector<std::uint32_t> values(accessor.at("count").get<std::size_t>());
    std::memcpy(values.data(), bytes_.data() + start(accessor), values.size() * sizeof(std::uint32_t));
    return values;
  }

  void scenes() {
    if (list("scenes").empty() || list("nodes").empty() || list("meshes").empty())
      problem("there is no scene with a node with a mesh");
    if (json_.contains("scene")) (void)index(json_["scene"], "scenes");
    for (const Json& scene : list("scenes"))
      for (const Json& node : scene.value("nodes", Json::array())) (void)index(node, "nodes");
    for (const Json& node : list("nodes"))
      if (node.contains("mesh")) (void)index(node["mesh"], "meshes");
  }

  // --- the contents of a good file

  template <int N>
  std::vector<Eigen::Matrix<float, N, 1>> vectors(const Json& primitive, const char* name) const {
    std::vector<Eigen::Matrix<float, N, 1>> result;
    if (!primitive["attributes"].contains(name)) return result;
    const std::vector<float> values =
        floats(list("accessors")[primitive["attributes"][name].get<std::size_t>()]);
    for (std::size_t i = 0; i < values.size(); i += N) result.emplace_back(values.data() + i);
    return result;
  }

  GltfPrimitive read_primitive(const Json& json) const {
    GltfPrimitive primitive;
    primitive.positions = vectors<3>(json, "POSITION");
    primitive.normals = vectors<3>(json, "NORMAL");
    primitive.colors = vectors<3>(json, "COLOR_0");
    primitive.tangents = vectors<4>(json, "TANGENT");
    primitive.uvs = vectors<2>(json, "TEXCOORD_0");
    primitive.indices = index_values(list("accessors")[json["indices"].get<std::size_t>()]);
    const Json& material = list("materials")[json["material"].get<std::size_t>()];
    primitive.material = material.value("name", "");
    primitive.unlit = material.value("extensions", Json::object()).contains("KHR_materials_unlit");
    const Json& pbr = material["pbrMetallicRoughness"];
    if (pbr.contains("baseColorFactor"))
      primitive.base_color = Eigen::Vector4f(pbr["baseColorFactor"].get<std::vector<float>>().data());
    if (pbr.contains("baseColorTexture")) {
      const Json& texture = list("textures")[pbr["baseColorTexture"]["index"].get<std::size_t>()];
      primitive.image = image_bytes(texture["source"].get<std::size_t>());
    }
    if (material.contains("normalTexture")) {
      const Json& texture = list("textures")[material["normalTexture"]["index"].get<std::size_t>()];
      primitive.normal_map = image_bytes(texture["source"].get<std::size_t>());
    }
    return primitive;
  }

  std::string bytes_;
  Json json_;
  std::size_t binary_ = 0;  // where the binary chunk's data start
  std::size_t binary_size_ = 0;
  std::size_t buffer_size_ = 0;
  std::set<std::string> used_;
  std::vector<std::string> problems_;
};

}  // namespace

std::vector<std::string> gltf_problems(const std::filesystem::path& file) {
  return Checker(file).check();
}

GltfModel read_gltf(const std::filesystem::path& file) {
  return Checker(file).read();
}

}  // namespace drape::test
