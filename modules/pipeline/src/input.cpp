#include "input_section.hpp"

#include <fmt/core.h>
#include <glob.h>

#include <algorithm>

#include "drape/base/numbers.hpp"
#include "drape/base/options.hpp"

namespace drape::pipeline {
namespace fs = std::filesystem;
namespace {

std::string help_of(const std::vector<InputKey>& keys, const std::string& name) {
  for (const InputKey& key : keys)
    if (key.name == name) return key.help;
  return {};
}

// One pass over a map of known keys; complains about the others.
class MapReader {
 public:
  MapReader(const ConfigNode& node, std::string path, const std::vector<InputKey>& keys,
            InputProblems& problems)
      : node_(node), path_(std::move(path)), keys_(keys), problems_(problems) {
    if (node.kind == ConfigNode::Kind::null) return;
    if (node.kind != ConfigNode::Kind::map) {
      problems_.wrong.push_back(
          fmt::format("{}: {}: must be a section of keys and values", node.where.text(), path_));
      return;
    }
    std::vector<std::string> names;
    for (const InputKey& key : keys) names.push_back(key.name);
    for (const ConfigNode::Key& key : node.keys)
      if (std::find(names.begin(), names.end(), key.name) == names.end())
        problems_.wrong.push_back(unknown_key(key, path_, names));
  }

  [[nodiscard]] const ConfigNode* find(const std::string& key) const {
    const ConfigNode* value = node_.kind == ConfigNode::Kind::map ? node_.find(key) : nullptr;
    return value != nullptr && value->kind != ConfigNode::Kind::null ? value : nullptr;
  }

  void wrong(const ConfigNode& value, const std::string& key, const std::string& what) {
    problems_.wrong.push_back(fmt::format("{}: {}.{}{}: {} ({})", value.where.text(), path_, key,
                                          value.kind == ConfigNode::Kind::scalar ? " = " + value.text : "",
                                          what, help_of(keys_, key)));
  }

  // The texts of a scalar, or of a sequence of scalars.
  [[nodiscard]] std::vector<std::string> texts(const ConfigNode& value, const std::string& key) {
    if (value.kind == ConfigNode::Kind::scalar) return {value.text};
    std::vector<std::string> list;
    for (const ConfigNode& item : value.items) {
      if (value.kind != ConfigNode::Kind::sequence || item.kind != ConfigNode::Kind::scalar) {
        wrong(value, key, "must be a single value or a list of them");
        return {};
      }
      list.push_back(item.text);
    }
    return list;
  }

  [[nodiscard]] std::vector<double> numbers(const std::string& key, std::size_t least, std::size_t most) {
    const ConfigNode* value = find(key);
    if (value == nullptr) return {};
    std::vector<double> list;
    for (const std::string& text : texts(*value, key)) {
      const auto number = parse_double(text);
      if (!number || !(std::abs(*number) < 1e12)) {
        wrong(*value, key, fmt::format("'{}' is no number", text));
        return {};
      }
      list.push_back(*number);
    }
    if (list.size() < least || list.size() > most) {
      const std::string count =
          least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most);
      wrong(*value, key, fmt::format("has {} numbers; must have {}", list.size(), count));
      return {};
    }
    return list;
  }

  [[nodiscard]] fs::path file(const std::string& key, const fs::path& folder) {
    const ConfigNode* value = find(key);
    if (value == nullptr) return {};
    if (value->kind != ConfigNode::Kind::scalar || value->text.empty()) {
      wrong(*value, key, "must be one file name");
      return {};
    }
    return existing(*value, key, value->text, folder);
  }

  [[nodiscard]] std::vector<fs::path> files(const std::string& key, const fs::path& folder) {
    const ConfigNode* value = find(key);
    if (value == nullptr) return {};
    std::vector<fs::path> list;
    for (const std::string& text : texts(*value, key)) {
      if (text.find_first_of("*?[") == std::string::npos) {
        list.push_back(existing(*value, key, text, folder));
        continue;
      }
      glob_t found{};
      const std::string pattern = (folder / text).string();
      if (::glob(pattern.c_str(), 0, nullptr, &found) == 0)
        for (std::size_t i = 0; i < found.gl_pathc; ++i)
          list.emplace_back(fs::path(found.gl_pathv[i]).lexically_normal());
      else
        problems_.missing.push_back(
            fmt::format("{}: {}.{} = {}: no file matches", value->where.text(), path_, key, text));
      ::globfree(&found);
    }
    return list;
  }

 private:
  [[nodiscard]] fs::path existing(const ConfigNode& value, const std::string& key, const std::string& text,
                                  const fs::path& folder) {
    fs::path path = (folder / text).lexically_normal();
    std::error_code ignored;
    if (!fs::exists(path, ignored))
      problems_.missing.push_back(
          fmt::format("{}: {}.{} = {}: no such file", value.where.text(), path_, key, text));
    else if (fs::is_directory(path, ignored))
      problems_.missing.push_back(
          fmt::format("{}: {}.{} = {}: is a folder, not a file", value.where.text(), path_, key, text));
    return path;
  }

  const ConfigNode& node_;
  std::string path_;
  const std::vector<InputKey>& keys_;
  InputProblems& problems_;
};

PhotoCamera read_photo_camera(const ConfigNode& node, const std::string& path, InputProblems& problems) {
  MapReader reader(node, path, photo_camera_keys(), problems);
  PhotoCamera camera;
  if (const auto focal = reader.numbers("focal_px", 1, 1); !focal.empty()) {
    if (focal[0] > 0)
      camera.focal_px = focal[0];
    else
      reader.wrong(*reader.find("focal_px"), "focal_px", "must be more than 0");
  }
  if (const auto k = reader.numbers("K", 9, 9); !k.empty()) {
    camera.K.emplace();
    std::copy(k.begin(), k.end(), camera.K->begin());
  }
  camera.distortion = reader.numbers("distortion", 4, 5);
  return camera;
}

PhotoInput read_photo_input(const ConfigNode& node, const std::string& path, const fs::path& folder,
                            InputProblems& problems) {
  PhotoInput photo;
  if (node.kind == ConfigNode::Kind::scalar) {  // a file name alone: no more is known of the photo
    ConfigNode map;
    map.kind = ConfigNode::Kind::map;
    map.where = node.where;
    map.keys.push_back({"image", node.where});
    map.items.push_back(node);
    photo.image = MapReader(map, path, photo_keys(), problems).file("image", folder);
    return photo;
  }
  MapReader reader(node, path, photo_keys(), problems);
  photo.image = reader.file("image", folder);
  if (photo.image.empty() && reader.find("image") == nullptr)
    problems.wrong.push_back(fmt::format("{}: {}: has no image", node.where.text(), path));
  photo.mask = reader.file("mask", folder);
  if (const auto box = reader.numbers("box_px", 4, 4); !box.empty()) {
    if (box[2] > 0 && box[3] > 0)
      photo.box_px = {box[0], box[1], box[2], box[3]};
    else
      reader.wrong(*reader.find("box_px"), "box_px", "width and height must be more than 0");
  }
  if (const auto click = reader.numbers("click_px", 2, 2); !click.empty())
    photo.click_px = {click[0], click[1]};
  if (const ConfigNode* camera = reader.find("camera"); camera != nullptr)
    photo.camera = read_photo_camera(*camera, path + ".camera", problems);
  return photo;
}

}  // namespace

const std::vector<InputKey>& input_keys() {
  static const std::vector<InputKey> keys = {
      {"scans", "scan files or patterns (scans/*.ply), relative to the configuration"},
      {"poses", "poses of the scans, such as a Stanford .conf file"},
      {"units", "units of the scans or the mesh: m, cm, mm, in, ft; auto guesses from their size"},
      {"up", "axis of the input that points up: x, y or z"},
      {"mesh", "a mesh to start from, instead of scans"},
      {"cameras", "a cameras.json whose cameras are taken as they are, instead of alignment"},
      {"photos", "the photos: file names, or sections with image and what is known of it"},
  };
  return keys;
}

const std::vector<InputKey>& photo_keys() {
  static const std::vector<InputKey> keys = {
      {"image", "the photo"},
      {"mask",
       "a picture of the photo's size: white where the object is, black elsewhere, grey (128) unknown"},
      {"box_px", "x, y, width, height of a box around the object, in upright pixels"},
      {"click_px", "x, y of a point inside the object, in upright pixels"},
      {"camera", "what is known of the camera: focal_px or K, distortion"},
  };
  return keys;
}

const std::vector<InputKey>& photo_camera_keys() {
  static const std::vector<InputKey> keys = {
      {"focal_px", "focal length in pixels of the upright photo"},
      {"K", "nine numbers of the 3x3 camera matrix, row by row"},
      {"distortion", "k1, k2, p1, p2 and perhaps k3, as OpenCV defines them"},
  };
  return keys;
}

std::optional<double> metres_per_unit(Units units) {
  switch (units) {
    case Units::guess:
      return std::nullopt;
    case Units::metres:
      return 1.0;
    case Units::centimetres:
      return 0.01;
    case Units::millimetres:
      return 0.001;
    case Units::inches:
      return 0.0254;
    case Units::feet:
      return 0.3048;
  }
  return std::nullopt;
}

Input read_input_section(const ConfigNode& node, const fs::path& folder, InputProblems& problems) {
  MapReader reader(node, "input", input_keys(), problems);
  Input input;
  input.scans = reader.files("scans", folder);
  input.poses = reader.file("poses", folder);
  input.mesh = reader.file("mesh", folder);
  input.cameras = reader.file("cameras", folder);

  struct Scalars {
    Units units = Units::guess;
    char up = 'z';
  } scalars;
  Binder binder;
  binder.choice("units", scalars.units,
                {{"auto", Units::guess},
                 {"m", Units::metres},
                 {"cm", Units::centimetres},
                 {"mm", Units::millimetres},
                 {"in", Units::inches},
                 {"ft", Units::feet}},
                "");
  binder.choice("up", scalars.up, {{"x", 'x'}, {"y", 'y'}, {"z", 'z'}}, "");
  for (const Option& option : binder.options()) {
    const ConfigNode* value = reader.find(option.name);
    if (value == nullptr) continue;
    const auto parsed = parse_option(option, value->text);
    if (std::holds_alternative<std::string>(parsed))
      reader.wrong(*value, option.name, std::get<std::string>(parsed));
    else
      option.assign(std::get<OptionValue>(parsed));
  }
  input.units = scalars.units;
  input.up = scalars.up;

  if (const ConfigNode* photos = reader.find("photos"); photos != nullptr) {
    if (photos->kind != ConfigNode::Kind::sequence)
      reader.wrong(*photos, "photos", "must be a list");
    else
      for (std::size_t i = 0; i < photos->items.size(); ++i)
        input.photos.push_back(
            read_photo_input(photos->items[i], fmt::format("input.photos[{}]", i), folder, problems));
  }
  if (input.scans.empty() && input.mesh.empty() && problems.wrong.empty() && problems.missing.empty())
    problems.wrong.push_back(fmt::format("{}: input has neither scans nor a mesh", node.where.text()));
  if (!input.scans.empty() && !input.mesh.empty())
    problems.wrong.push_back(
        fmt::format("{}: input has both scans and a mesh; leave one of them out", node.where.text()));
  return input;
}

std::string unknown_key(const ConfigNode::Key& key, const std::string& section,
                        const std::vector<std::string>& names) {
  const std::string guess = closest(key.name, names);
  return fmt::format("{}: {}{}: no such key{}", key.where.text(), section.empty() ? "" : section + ".",
                     key.name, guess.empty() ? "" : "; did you mean " + guess + "?");
}

}  // namespace drape::pipeline
