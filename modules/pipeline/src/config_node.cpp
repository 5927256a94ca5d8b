#include "drape/pipeline/config_node.hpp"

#include <fmt/core.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <istream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "drape/base/error.hpp"
#include "drape/base/numbers.hpp"

namespace drape::pipeline {
namespace {

constexpr std::size_t max_depth = 32;
constexpr std::size_t max_nodes = 10000;

// Builds the tree from the parser's events. yaml-cpp's own tree is not used: it resolves aliases (a
// bomb of 300 bytes walks for hours, cycles for ever) and lets duplicate keys pass.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(ConfigNode& root, const std::string& source) : root_(root), source_(source) {}

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    refuse_anchor(mark, anchor);
    // An empty value reads as null; so does a key without a name.
    if (wants_key()) throw config_error("{}: a key has no name", place(mark).text());
    add(mark, ConfigNode::Kind::null);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    throw config_error("{}: aliases (*name) are not allowed here; write the value out", place(mark).text());
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    refuse_anchor(mark, anchor);
    refuse_tag(mark, tag);
    if (wants_key()) {
      add_key(mark, value);
      return;
    }
    // "~" and "null" arrive as plain scalars.
    const bool null = tag == "?" && (value == "~" || value == "null");
    ConfigNode& node = add(mark, null ? ConfigNode::Kind::null : ConfigNode::Kind::scalar);
    node.text = value;
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, tag, anchor, ConfigNode::Kind::sequence);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, tag, anchor, ConfigNode::Kind::map);
  }
  void OnMapEnd() override { close(); }

 private:
  [[nodiscard]] Location place(const YAML::Mark& mark) const {
    return {source_, mark.line + 1, mark.column + 1};
  }

  [[nodiscard]] bool wants_key() const {
    return !path_.empty() && path_.back()->kind == ConfigNode::Kind::map &&
           path_.back()->keys.size() == path_.back()->items.size();
  }

  void refuse_anchor(const YAML::Mark& mark, YAML::anchor_t anchor) const {
    if (anchor != 0) throw config_error("{}: anchors (&name) are not allowed here", place(mark).text());
  }

  void refuse_tag(const YAML::Mark& mark, const std::string& tag) const {
    if (!tag.empty() && tag != "?" && tag != "!")
      throw config_error("{}: tags ({}) are not allowed here", place(mark).text(), tag);
  }

  void add_key(const YAML::Mark& mark, const std::string& name) {
    ConfigNode& map = *path_.back();
    for (const ConfigNode::Key& key : map.keys)
      if (key.name == name)
        throw config_error("{}: {} is given twice (first in line {})", place(mark).text(), name,
                           key.where.line);
    map.keys.push_back({name, place(mark)});
  }

  ConfigNode& add(const YAML::Mark& mark, ConfigNode::Kind kind) {
    if (++nodes_ > max_nodes) throw config_error("{}: more than {} values", place(mark).text(), max_nodes);
    ConfigNode* node = &root_;
    if (!path_.empty()) node = &path_.back()->items.emplace_back();
    node->kind = kind;
    node->where = place(mark);
    return *node;
  }

  void open(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, ConfigNode::Kind kind) {
    refuse_anchor(mark, anchor);
    refuse_tag(mark, tag);
    if (wants_key()) throw config_error("{}: a key must be a single word", place(mark).text());
    if (path_.size() >= max_depth)
      throw config_error("{}: nested deeper than {} levels", place(mark).text(), max_depth);
    // A node on the path is the last item of its parent and gets no sibling before it is closed: pointers
    // stay valid.
    path_.push_back(&add(mark, kind));
  }

  void close() { path_.pop_back(); }

  ConfigNode& root_;
  const std::string& source_;
  std::vector<ConfigNode*> path_;
  std::size_t nodes_ = 0;
};

struct PathStep {
  std::string key;  // empty: an index
  std::size_t index = 0;
};

std::vector<PathStep> split_path(std::string_view path) {
  std::vector<PathStep> steps;
  const auto wrong = [&] {
    return config_error("--set {}: not a path like fill.base or input.photos[0].mask", path);
  };
  std::size_t i = 0;
  while (i < path.size()) {
    if (path[i] == '[') {
      const std::size_t end = path.find(']', i);
      if (end == std::string_view::npos) throw wrong();
      const auto index = parse_integer(path.substr(i + 1, end - i - 1));
      if (!index || *index < 0) throw wrong();
      steps.push_back({{}, static_cast<std::size_t>(*index)});
      i = end + 1;
      continue;
    }
    if (path[i] == '.' && !steps.empty()) ++i;
    const std::size_t end = std::min(path.find_first_of(".[", i), path.size());
    if (end == i) throw wrong();
    steps.push_back({std::string(path.substr(i, end - i)), 0});
    i = end;
  }
  if (steps.empty()) throw wrong();
  return steps;
}

ConfigNode& child(ConfigNode& node, const PathStep& step, std::string_view path, const Location& where) {
  if (step.key.empty()) {
    if (node.kind == ConfigNode::Kind::null) node.kind = ConfigNode::Kind::sequence;
    if (node.kind != ConfigNode::Kind::sequence || step.index > node.items.size())
      throw config_error("--set {}: there is no [{}]", path, step.index);
    if (step.index == node.items.size()) node.items.emplace_back().where = where;
    return node.items[step.index];
  }
  if (node.kind == ConfigNode::Kind::null) node.kind = ConfigNode::Kind::map;
  if (node.kind != ConfigNode::Kind::map)
    throw config_error("--set {}: what {} is in is no section", path, step.key);
  for (std::size_t i = 0; i < node.keys.size(); ++i)
    if (node.keys[i].name == step.key) return node.items[i];
  node.keys.push_back({step.key, where});
  node.items.emplace_back().where = where;
  return node.items.back();
}

}  // namespace

std::string Location::text() const {
  return line > 0 ? fmt::format("{}:{}:{}", source, line, column) : source;
}

const ConfigNode* ConfigNode::find(std::string_view key) const {
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (keys[i].name == key) return &items[i];
  return nullptr;
}

ConfigNode parse_yaml(std::string_view yaml, const std::string& source) {
  ConfigNode root;
  root.where = {source, 0, 0};
  std::istringstream stream{std::string(yaml)};
  try {
    YAML::Parser parser(stream);
    TreeBuilder builder(root, source);
    if (!parser.HandleNextDocument(builder)) return root;
    ConfigNode second;
    TreeBuilder second_builder(second, source);
    if (parser.HandleNextDocument(second_builder))
      throw config_error("{}: holds more than one document", source);
  } catch (const YAML::Exception& failure) {
    const Location where{source, failure.mark.line + 1, failure.mark.column + 1};
    throw config_error("{}: {}", where.text(), failure.msg);
  }
  return root;
}

void set_value(ConfigNode& root, std::string_view path, std::string_view value) {
  const Location where{fmt::format("--set {}", path), 0, 0};
  ConfigNode* node = &root;
  for (const PathStep& step : split_path(path)) node = &child(*node, step, path, where);
  *node = parse_yaml(value, where.source);
  node->where = where;
}

void set_value(ConfigNode& root, std::string_view path_and_value) {
  const std::size_t equals = path_and_value.find('=');
  if (equals == std::string_view::npos)
    throw config_error("--set {}: must be key=value, such as fill.base=flat", path_and_value);
  set_value(root, path_and_value.substr(0, equals), path_and_value.substr(equals + 1));
}

void lay_over(ConfigNode& lower, const ConfigNode& upper) {
  if (lower.kind != ConfigNode::Kind::map || upper.kind != ConfigNode::Kind::map) {
    lower = upper;
    return;
  }
  for (std::size_t i = 0; i < upper.keys.size(); ++i) {
    const auto same = std::find_if(lower.keys.begin(), lower.keys.end(), [&](const ConfigNode::Key& key) {
      return key.name == upper.keys[i].name;
    });
    if (same != lower.keys.end()) {
      lay_over(lower.items[static_cast<std::size_t>(same - lower.keys.begin())], upper.items[i]);
      continue;
    }
    lower.keys.push_back(upper.keys[i]);
    lower.items.push_back(upper.items[i]);
  }
}

std::string flow_text(const ConfigNode& node) {
  const auto quoted = [](const std::string& text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  };
  std::string text;
  switch (node.kind) {
    case ConfigNode::Kind::null:
      return "null";
    case ConfigNode::Kind::scalar:
      return quoted(node.text);
    case ConfigNode::Kind::sequence:
      for (const ConfigNode& item : node.items) text += (text.empty() ? "" : ", ") + flow_text(item);
      return "[" + text + "]";
    case ConfigNode::Kind::map:
      for (std::size_t i = 0; i < node.keys.size(); ++i)
        text += (text.empty() ? "" : ", ") + quoted(node.keys[i].name) + ": " + flow_text(node.items[i]);
      return "{" + text + "}";
  }
  return text;
}

}  // namespace drape::pipeline
