#include "map_reader.hpp"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <cmath>

#include "drape/base/numbers.hpp"

namespace drape::pipeline {
namespace fs = std::filesystem;
namespace {

std::string help_of(const std::vector<InputKey>& keys, const std::string& name) {
  for (const InputKey& key : keys)
    if (key.name == name) return key.help;
  return {};
}

}  // namespace

MapReader::MapReader(const ConfigNode& node, std::string path, const std::vector<InputKey>& keys,
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

const ConfigNode* MapReader::find(const std::string& key) const {
  const ConfigNode* value = node_.kind == ConfigNode::Kind::map ? node_.find(key) : nullptr;
  return value != nullptr && value->kind != ConfigNode::Kind::null ? value : nullptr;
}

void MapReader::wrong(const ConfigNode& value, const std::string& key, const std::string& what) {
  problems_.wrong.push_back(fmt::format("{}: {}.{}{}: {} ({})", value.where.text(), path_, key,
                                        value.kind == ConfigNode::Kind::scalar ? " = " + value.text : "",
                                        what, help_of(keys_, key)));
}

std::vector<std::string> MapReader::texts(const ConfigNode& value, const std::string& key) {
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

std::vector<double> MapReader::numbers(const std::string& key, std::size_t least, std::size_t most) {
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
    const std::string count = least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most);
    wrong(*value, key, fmt::format("has {} numbers; must have {}", list.size(), count));
    return {};
  }
  return list;
}

fs::path MapReader::file(const std::string& key, const fs::path& folder) {
  const ConfigNode* value = find(key);
  if (value == nullptr) return {};
  if (value->kind != ConfigNode::Kind::scalar || value->text.empty()) {
    wrong(*value, key, "must be one file name");
    return {};
  }
  return existing(*value, key, value->text, folder);
}

std::vector<fs::path> MapReader::files(const std::string& key, const fs::path& folder) {
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

fs::path MapReader::existing(const ConfigNode& value, const std::string& key, const std::string& text,
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

}  // namespace drape::pipeline
