// YAML as a plain tree with the place of every node, after all that makes YAML dangerous was refused.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace drape::pipeline {

/// Where a node stands, for messages: "config.yaml:3:7", or "--set" for what came from the command line.
struct Location {
  std::string source;
  int line = 0;  // from 1; 0: no line to speak of
  int column = 0;

  [[nodiscard]] std::string text() const;
};

struct ConfigNode {
  enum class Kind { null, scalar, sequence, map };
  struct Key {
    std::string name;
    Location where;
  };

  Kind kind = Kind::null;
  std::string text;               // of a scalar
  std::vector<ConfigNode> items;  // of a sequence; of a map: the value of keys[i]
  std::vector<Key> keys;          // of a map
  Location where;

  /// The value of a map's key, or null.
  [[nodiscard]] const ConfigNode* find(std::string_view key) const;
};

/// One YAML document. `source` names it in messages. Error{config} with line and column for what is no YAML,
/// and for aliases, duplicate keys, tags, more than 32 levels or 10,000 nodes, more than one document.
[[nodiscard]] ConfigNode parse_yaml(std::string_view yaml, const std::string& source);

/// Puts `value` (YAML in one line) where `path` says: "fill.base", "input.photos[0].mask". Maps on the way
/// are made; an index may be one past the end. Error{config}.
void set_value(ConfigNode& root, std::string_view path, std::string_view value);
/// The same for "path=value", as --set has it.
void set_value(ConfigNode& root, std::string_view path_and_value);

/// Puts what `upper` says over `lower`: maps key by key, everything else as a whole.
void lay_over(ConfigNode& lower, const ConfigNode& upper);

/// YAML in one line, which parse_yaml reads back to the same tree but for the places of its nodes. It is JSON
/// too: every scalar is quoted.
[[nodiscard]] std::string flow_text(const ConfigNode& node);

}  // namespace drape::pipeline
