#include "drape/pipeline/fixes.hpp"

#include <algorithm>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/options.hpp"
#include "input_section.hpp"

namespace drape::pipeline {
namespace fs = std::filesystem;
namespace {

ConfigNode* find(ConfigNode& map, const std::string& key) {
  for (std::size_t i = 0; i < map.keys.size(); ++i)
    if (map.keys[i].name == key) return &map.items[i];
  return nullptr;
}

std::string base_name(const ConfigNode& photo) {
  const ConfigNode* image = photo.kind == ConfigNode::Kind::map ? photo.find("image") : &photo;
  return image == nullptr ? "" : fs::path(image->text).filename().string();
}

void check_map(const ConfigNode& node, const std::string& name) {
  if (node.kind != ConfigNode::Kind::map && node.kind != ConfigNode::Kind::null)
    throw config_error("{}: {}: must be keys and values", node.where.text(), name);
}

ObjectFixes read_entry(const ConfigNode& node, const fs::path& folder) {
  if (node.kind != ConfigNode::Kind::map)
    throw config_error("{}: a fix must be keys and values", node.where.text());
  ObjectFixes fixes;
  fixes.where = node.where;
  for (std::size_t i = 0; i < node.keys.size(); ++i) {
    const std::string& key = node.keys[i].name;
    if (key == "object")
      fixes.object = node.items[i].text;
    else if (key == "photos")
      fixes.photos = node.items[i];
    else if (key == "set")
      fixes.set = node.items[i];
    else
      throw config_error("{}", unknown_key(node.keys[i], "fixes", {"object", "photos", "set"}));
  }
  check_map(fixes.photos, "photos");
  check_map(fixes.set, "set");
  for (ConfigNode& photo : fixes.photos.items) {
    check_map(photo, "a photo");
    for (const char* key : {"mask", "scribbles", "background"})
      if (ConfigNode* picture = find(photo, key))
        picture->text = (folder / picture->text).lexically_normal().string();
  }
  return fixes;
}

bool drops(const ConfigNode& fix) {
  const ConfigNode* drop = fix.find("drop");
  if (drop == nullptr) return false;
  if (drop->text != "true" && drop->text != "false")
    throw config_error("{}: drop: must be true or false", drop->where.text());
  return drop->text == "true";
}

// Returns whether the photo is to be left out.
bool fix_photo(ConfigNode& photo, ConfigNode fix) {
  if (drops(fix)) return true;
  if (photo.kind == ConfigNode::Kind::scalar) {
    ConfigNode map;
    map.kind = ConfigNode::Kind::map;
    map.where = photo.where;
    map.keys.push_back({"image", photo.where});
    map.items.push_back(photo);
    photo = std::move(map);
  }
  for (std::size_t i = fix.keys.size(); i-- > 0;)
    if (fix.keys[i].name == "drop") {
      fix.keys.erase(fix.keys.begin() + static_cast<std::ptrdiff_t>(i));
      fix.items.erase(fix.items.begin() + static_cast<std::ptrdiff_t>(i));
    }
  lay_over(photo, fix);
  return false;
}

}  // namespace

std::vector<ObjectFixes> read_fixes(const fs::path& file) {
  const ConfigNode root = parse_yaml(read_file(file), file.string());
  const ConfigNode* list = root.find("fixes");
  if (list == nullptr || list->kind != ConfigNode::Kind::sequence)
    throw config_error("{}: has no list of fixes:", file.string());
  std::vector<ObjectFixes> fixes;
  for (const ConfigNode& entry : list->items)
    fixes.push_back(read_entry(entry, fs::absolute(file).parent_path()));
  return fixes;
}

void write_fixes(const fs::path& file, const std::vector<ObjectFixes>& fixes) {
  std::string text = "fixes:\n";
  for (const ObjectFixes& one : fixes) {
    ConfigNode object;
    object.kind = ConfigNode::Kind::scalar;
    object.text = one.object;
    text += "  - object: " + flow_text(object) + "\n";
    if (one.photos.kind == ConfigNode::Kind::map) text += "    photos: " + flow_text(one.photos) + "\n";
    if (one.set.kind == ConfigNode::Kind::map) text += "    set: " + flow_text(one.set) + "\n";
  }
  write_file(file, fixes.empty() ? "fixes: []\n" : text);
}

void apply_fixes(ConfigNode& root, const ObjectFixes& fixes) {
  ConfigNode* input = find(root, "input");
  ConfigNode* photos = input == nullptr ? nullptr : find(*input, "photos");
  for (std::size_t i = 0; i < fixes.photos.keys.size(); ++i) {
    const ConfigNode::Key& key = fixes.photos.keys[i];
    std::vector<std::string> names;
    bool found = false;
    for (std::size_t j = 0; photos != nullptr && j < photos->items.size(); ++j) {
      names.push_back(base_name(photos->items[j]));
      if (names.back() != key.name) continue;
      found = true;
      if (fix_photo(photos->items[j], fixes.photos.items[i]))
        photos->items.erase(photos->items.begin() + static_cast<std::ptrdiff_t>(j));
      break;
    }
    const std::string guess = closest(key.name, names);
    if (!found)
      throw config_error("{}: {}: no such photo in this run{}", key.where.text(), key.name,
                         guess.empty() ? "" : "; did you mean " + guess + "?");
  }
  for (std::size_t i = 0; i < fixes.set.keys.size(); ++i)
    set_value(root, fixes.set.keys[i].name, flow_text(fixes.set.items[i]));
}

std::vector<ObjectFixes> joined(std::vector<ObjectFixes> older, const std::vector<ObjectFixes>& newer) {
  for (const ObjectFixes& fix : newer) {
    const auto same = std::find_if(older.begin(), older.end(),
                                   [&](const ObjectFixes& known) { return known.object == fix.object; });
    if (same == older.end()) {
      older.push_back(fix);
      continue;
    }
    if (fix.photos.kind != ConfigNode::Kind::null) lay_over(same->photos, fix.photos);
    if (fix.set.kind != ConfigNode::Kind::null) lay_over(same->set, fix.set);
  }
  return older;
}

}  // namespace drape::pipeline
