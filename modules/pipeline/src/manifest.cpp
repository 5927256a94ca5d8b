#include "drape/pipeline/manifest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "csv.hpp"
#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "input_paths.hpp"
#include "input_section.hpp"

namespace drape::pipeline {
namespace fs = std::filesystem;
namespace {

ConfigNode scalar(std::string text, const Location& where) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::scalar;
  node.text = std::move(text);
  node.where = where;
  return node;
}

ConfigNode map_node(const Location& where) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::map;
  node.where = where;
  return node;
}

ConfigNode& member(ConfigNode& map, const std::string& key, const Location& where) {
  for (std::size_t i = 0; i < map.keys.size(); ++i)
    if (map.keys[i].name == key) return map.items[i];
  map.keys.push_back({key, where});
  map.items.emplace_back().where = where;
  return map.items.back();
}

std::vector<std::string> input_key_names() {
  std::vector<std::string> names;
  for (const InputKey& key : input_keys()) names.push_back(key.name);
  return names;
}

bool is_input_key(const std::string& name) {
  const std::vector<std::string> names = input_key_names();
  return std::find(names.begin(), names.end(), name) != names.end();
}

// A batch says itself where results go.
ConfigNode read_base(const fs::path& file) {
  ConfigNode root = parse_yaml(read_file(file), file.string());
  if (root.kind != ConfigNode::Kind::map) throw config_error("{}: is no configuration", file.string());
  for (std::size_t i = root.keys.size(); i-- > 0;)
    if (root.keys[i].name == "workspace" || root.keys[i].name == "output" || root.keys[i].name == "sweep") {
      root.keys.erase(root.keys.begin() + static_cast<std::ptrdiff_t>(i));
      root.items.erase(root.items.begin() + static_cast<std::ptrdiff_t>(i));
    }
  make_input_paths_absolute(root, fs::absolute(file).parent_path());
  return root;
}

// Collects objects, and everything that is wrong with the list.
class ObjectList {
 public:
  ObjectList(Batch& batch, fs::path folder) : batch_(batch), folder_(std::move(folder)) {}

  ConfigNode base = map_node({});

  void add(const std::string& id, const Location& where, ConfigNode object_base, ConfigNode input,
           const std::vector<std::pair<std::string, ConfigNode>>& sets, const std::string& unreadable) {
    if (!is_name(id)) {
      problem(where, id.empty() ? "an object has no id"
                                : fmt::format(
                                      "id {}: must be of letters, digits, '.', '_' and '-', and start with a "
                                      "letter or digit: it names folders",
                                      id));
      return;
    }
    if (!ids_.insert(id).second) {
      problem(where, fmt::format("id {} is given twice", id));
      return;
    }
    BatchObject object;
    object.id = id;
    object.unreadable = unreadable;
    object.root = base;
    lay_over(object.root, object_base);
    ConfigNode own = map_node(where);
    member(own, "input", where) = std::move(input);
    make_input_paths_absolute(own, folder_);
    lay_over(object.root, own);
    try {
      for (const auto& [path, value] : sets) set_value(object.root, path, flow_text(value));
    } catch (const Error& error) {
      problem(where, error.what());
    }
    batch_.objects.push_back(std::move(object));
  }

  /// An object's own configuration; one that cannot be read is the object's failure alone.
  [[nodiscard]] static ConfigNode read_own(const fs::path& file, std::string& unreadable) {
    try {
      return read_base(file);
    } catch (const Error& error) {
      unreadable = error.what();
      return map_node({});
    }
  }

  void problem(const Location& where, const std::string& what) {
    problems_.push_back(fmt::format("{}: {}", where.text(), what));
  }

  void finish() const {
    if (!problems_.empty()) throw config_error("{}", fmt::join(problems_, "\n"));
    if (batch_.objects.empty()) throw config_error("{}: names no object", batch_.source.string());
  }

 private:
  static bool is_name(const std::string& id) {
    const auto plain = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    };
    return !id.empty() && id.size() <= 200 && plain(id[0]) && std::all_of(id.begin(), id.end(), [&](char c) {
      return plain(c) || c == '.' || c == '_' || c == '-';
    });
  }

  Batch& batch_;
  fs::path folder_;
  std::set<std::string> ids_;
  std::vector<std::string> problems_;
};

void add_yaml_object(const ConfigNode& node, const fs::path& folder, ObjectList& list) {
  if (node.kind != ConfigNode::Kind::map) {
    list.problem(node.where, "an object must be a section of keys and values");
    return;
  }
  std::string id;
  std::string unreadable;
  ConfigNode base = map_node(node.where);
  ConfigNode input = map_node(node.where);
  std::vector<std::pair<std::string, ConfigNode>> sets;
  for (std::size_t i = 0; i < node.keys.size(); ++i) {
    const std::string& key = node.keys[i].name;
    const ConfigNode& value = node.items[i];
    if (key == "id") {
      id = value.text;
    } else if (key == "config") {
      base = ObjectList::read_own(folder / value.text, unreadable);
    } else if (key == "set") {
      for (std::size_t j = 0; j < value.keys.size(); ++j)
        sets.emplace_back(value.keys[j].name, value.items[j]);
    } else if (is_input_key(key)) {
      member(input, key, node.keys[i].where) = value;
    } else {
      std::vector<std::string> names = input_key_names();
      names.insert(names.end(), {"id", "config", "set"});
      list.problem(node.keys[i].where,
                   unknown_key(node.keys[i], "objects", names).substr(node.keys[i].where.text().size() + 2));
    }
  }
  list.add(id, node.where, base, input, sets, unreadable);
}

void read_yaml(Batch& batch, const fs::path& folder, ObjectList& list) {
  const ConfigNode root = parse_yaml(read_file(batch.source), batch.source.string());
  const std::vector<std::string> names = {"config", "workspace", "output", "objects"};
  for (std::size_t i = 0; i < root.keys.size(); ++i) {
    const std::string& key = root.keys[i].name;
    if (std::find(names.begin(), names.end(), key) == names.end())
      throw config_error("{}", unknown_key(root.keys[i], "", names));
    if (key == "config") list.base = read_base(folder / root.items[i].text);
    if (key == "workspace") batch.workspace = (folder / root.items[i].text).lexically_normal();
    if (key == "output") batch.output = (folder / root.items[i].text).lexically_normal();
  }
  const ConfigNode* objects = root.find("objects");
  if (objects == nullptr || objects->kind != ConfigNode::Kind::sequence)
    throw config_error("{}: is no manifest: it has no list of objects:", batch.source.string());
  for (const ConfigNode& object : objects->items) add_yaml_object(object, folder, list);
}

// "a.ply; b.ply" -> a list; one value -> a scalar.
ConfigNode cell_node(const std::string& cell, bool as_list, const Location& where) {
  ConfigNode list;
  list.kind = ConfigNode::Kind::sequence;
  list.where = where;
  for (std::size_t begin = 0; begin <= cell.size();) {
    const std::size_t end = std::min(cell.find(';', begin), cell.size());
    const std::size_t first = cell.find_first_not_of(' ', begin);
    const std::size_t last = end == 0 ? std::string::npos : cell.find_last_not_of(' ', end - 1);
    if (first != std::string::npos && first < end && last != std::string::npos)
      list.items.push_back(scalar(cell.substr(first, last - first + 1), where));
    begin = end + 1;
  }
  if (!as_list && list.items.size() == 1) return list.items[0];
  return list;
}

void read_csv(const Batch& batch, const fs::path& folder, ObjectList& list) {
  const std::vector<CsvRow> rows = parse_csv(read_file(batch.source), batch.source.string());
  if (rows.empty()) throw config_error("{}: is empty", batch.source.string());
  const CsvRow& head = rows[0];
  for (std::size_t c = 0; c < head.cells.size(); ++c) {
    const std::string& name = head.cells[c];
    const bool known =
        name == "id" || name == "config" || is_input_key(name) || name.find('.') != std::string::npos;
    if (!known)
      list.problem({batch.source.string(), head.line, static_cast<int>(c) + 1},
                   fmt::format("column {}: must be id, config, {}, or an option such as fill.base", name,
                               fmt::join(input_key_names(), ", ")));
  }
  for (std::size_t r = 1; r < rows.size(); ++r) {
    const Location where{batch.source.string(), rows[r].line, 1};
    std::string id;
    std::string unreadable;
    ConfigNode base = map_node(where);
    ConfigNode input = map_node(where);
    std::vector<std::pair<std::string, ConfigNode>> sets;
    if (rows[r].cells.size() > head.cells.size())
      list.problem(
          where, fmt::format("has {} cells; the first line has {}", rows[r].cells.size(), head.cells.size()));
    for (std::size_t c = 0; c < std::min(head.cells.size(), rows[r].cells.size()); ++c) {
      const std::string& name = head.cells[c];
      const std::string& cell = rows[r].cells[c];
      if (cell.empty()) continue;
      if (name == "id")
        id = cell;
      else if (name == "config")
        base = ObjectList::read_own(folder / cell, unreadable);
      else if (is_input_key(name))
        member(input, name, where) = cell_node(cell, name == "photos" || name == "scans", where);
      else
        sets.emplace_back(name, cell_node(cell, false, where));
    }
    list.add(id, where, base, input, sets, unreadable);
  }
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
    if (entry.is_regular_file() && entry.path().filename().string()[0] != '.') files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

ConfigNode input_of_folder(const fs::path& folder, const Location& where) {
  ConfigNode input = map_node(where);
  std::vector<fs::path> conf;
  for (const fs::path& part : {folder, folder / "scans"})
    for (const fs::path& file : files_in(part)) {
      if (extension(file) == "conf")
        member(input, "poses", where) = scalar(file.string(), where);
      else if (part != folder)
        member(input, "scans", where).items.push_back(scalar(file.string(), where));
      else if (file.stem() == "mesh")
        member(input, "mesh", where) = scalar(file.string(), where);
    }
  if (input.find("scans") != nullptr) member(input, "scans", where).kind = ConfigNode::Kind::sequence;
  const std::vector<fs::path> pictures = files_in(folder / "photos");
  for (const fs::path& photo : pictures) {
    const std::string stem = photo.stem().string();
    if (stem.size() > 5 && stem.substr(stem.size() - 5) == "_mask") continue;
    ConfigNode entry = map_node(where);
    member(entry, "image", where) = scalar(photo.string(), where);
    const fs::path mask = photo.parent_path() / (stem + "_mask.png");
    if (fs::exists(mask)) member(entry, "mask", where) = scalar(mask.string(), where);
    ConfigNode& photos = member(input, "photos", where);
    photos.kind = ConfigNode::Kind::sequence;
    photos.items.push_back(entry);
  }
  return input;
}

void read_folder(const Batch& batch, ObjectList& list) {
  std::vector<fs::path> folders;
  for (const fs::directory_entry& entry : fs::directory_iterator(batch.source))
    if (const std::string name = entry.path().filename().string();
        entry.is_directory() && name[0] != '.' && name.rfind("drape-", 0) != 0)
      folders.push_back(entry.path());
  std::sort(folders.begin(), folders.end());
  for (const fs::path& folder : folders) {
    const Location where{folder.string(), 0, 0};
    const bool own = fs::exists(folder / "drape.yaml");
    std::string unreadable;
    const ConfigNode base = own ? ObjectList::read_own(folder / "drape.yaml", unreadable) : map_node(where);
    list.add(folder.filename().string(), where, base, own ? map_node(where) : input_of_folder(folder, where),
             {}, unreadable);
  }
}

}  // namespace

Batch read_manifest(const fs::path& manifest) {
  Batch batch;
  batch.source = fs::absolute(manifest).lexically_normal();
  if (!batch.source.has_filename()) batch.source = batch.source.parent_path();
  if (!fs::exists(batch.source)) throw config_error("{}: no such manifest", manifest.string());
  const bool is_folder = fs::is_directory(batch.source);
  const fs::path folder = is_folder ? batch.source : batch.source.parent_path();
  batch.name = is_folder ? batch.source.filename().string() : batch.source.stem().string();
  batch.workspace = folder / "drape-workspace";
  batch.output = folder / (is_folder ? "drape-models" : batch.name + "-models");
  ObjectList list(batch, folder);
  if (is_folder)
    read_folder(batch, list);
  else if (extension(batch.source) == "csv")
    read_csv(batch, folder, list);
  else
    read_yaml(batch, folder, list);
  list.finish();
  return batch;
}

}  // namespace drape::pipeline
