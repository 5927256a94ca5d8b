#include "drape/pipeline/config.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/numbers.hpp"
#include "input_section.hpp"

namespace drape::pipeline {
namespace fs = std::filesystem;
namespace {

// The value as the user wrote it, for messages.
std::string written(const ConfigNode& node) {
  switch (node.kind) {
    case ConfigNode::Kind::null:
      return "";
    case ConfigNode::Kind::scalar:
      return " = " + node.text;
    case ConfigNode::Kind::sequence:
      return " = [...]";
    case ConfigNode::Kind::map:
      return " = {...}";
  }
  return "";
}

std::variant<OptionValue, std::string> parse_node(const Option& option, const ConfigNode& node) {
  if (node.kind == ConfigNode::Kind::scalar) return parse_option(option, node.text);
  if (node.kind != ConfigNode::Kind::sequence) return std::string("has no value");
  std::vector<std::string> texts;
  for (const ConfigNode& item : node.items) {
    if (item.kind != ConfigNode::Kind::scalar) return std::string("must be a list of single values");
    texts.push_back(item.text);
  }
  return parse_option(option, texts);
}

void read_settings(const ConfigNode& root, const fs::path& folder, Config& config,
                   std::vector<std::string>& problems) {
  const auto path_of = [&](const char* key, const fs::path& fallback) {
    const ConfigNode* node = root.find(key);
    if (node == nullptr) return fallback;
    if (node->kind != ConfigNode::Kind::scalar || node->text.empty()) {
      problems.push_back(fmt::format("{}: {}: must be the name of a folder", node->where.text(), key));
      return fallback;
    }
    return (folder / node->text).lexically_normal();
  };
  config.workspace = path_of("workspace", folder / "drape-workspace");
  config.output = path_of("output", folder / (config.name + "-model"));
  if (const ConfigNode* seed = root.find("seed"); seed != nullptr) {
    const auto number = parse_integer(seed->text);
    if (number && *number >= 0)
      config.seed = static_cast<std::uint64_t>(*number);
    else
      problems.push_back(
          fmt::format("{}: seed{}: must be a whole number from 0", seed->where.text(), written(*seed)));
  }
}

void refuse_unknown_sections(const ConfigNode& root, std::span<const Stage> table,
                             std::vector<std::string>& problems) {
  std::vector<std::string> names;
  for (const InputKey& key : top_level_keys()) names.push_back(key.name);
  for (const Stage& stage : table) names.push_back(stage.name);
  for (const ConfigNode::Key& key : root.keys)
    if (std::find(names.begin(), names.end(), key.name) == names.end())
      problems.push_back(unknown_key(key, "", names));
}

}  // namespace

const std::vector<InputKey>& top_level_keys() {
  static const std::vector<InputKey> keys = {
      {"input", "which files there are, and what is known of them"},
      {"output", "folder for the finished model; default: <name of the configuration>-model beside it"},
      {"workspace", "folder for the stages' results; default: drape-workspace beside the configuration"},
      {"sweep", "an experiment for `drape sweep`: objects, seeds or repeats, grid, list; see the tutorial"},
      {"seed", "of everything random; the same seed gives the same bytes; default: 1"},
  };
  return keys;
}

void assign_options(const std::vector<Option>& options, const ConfigNode& section_node,
                    const std::string& section, std::vector<std::string>& problems) {
  if (section_node.kind == ConfigNode::Kind::null) return;
  if (section_node.kind != ConfigNode::Kind::map) {
    problems.push_back(
        fmt::format("{}: {}: must be a section of keys and values", section_node.where.text(), section));
    return;
  }
  std::vector<std::string> names;
  for (const Option& option : options) names.push_back(option.name);
  for (std::size_t i = 0; i < section_node.keys.size(); ++i) {
    const ConfigNode::Key& key = section_node.keys[i];
    const ConfigNode& value = section_node.items[i];
    const auto option =
        std::find_if(options.begin(), options.end(), [&](const Option& o) { return o.name == key.name; });
    if (option == options.end()) {
      problems.push_back(unknown_key(key, section, names));
      continue;
    }
    const auto parsed = parse_node(*option, value);
    if (std::holds_alternative<std::string>(parsed))
      problems.push_back(fmt::format("{}: {}{}{}{}: {} ({})", value.where.text(), section,
                                     section.empty() ? "" : ".", key.name, written(value),
                                     std::get<std::string>(parsed), option->help));
    else
      option->assign(std::get<OptionValue>(parsed));
  }
}

Config load_config(const fs::path& file, std::span<const Stage> table, std::span<const std::string> sets) {
  std::string text = read_file(file);
  ConfigNode root = parse_yaml(text, file.string());
  return configure(
      {file.stem().string(), fs::absolute(file).lexically_normal(), std::move(text), std::move(root)}, table,
      sets);
}

Config configure(ConfigSource source, std::span<const Stage> table, std::span<const std::string> sets) {
  Config config;
  config.file = std::move(source.file);
  config.name = std::move(source.name);
  config.text = std::move(source.text);
  config.sets.assign(sets.begin(), sets.end());
  const fs::path folder = config.file.parent_path();

  ConfigNode root = std::move(source.root);
  if (root.kind != ConfigNode::Kind::map)
    throw config_error("{}: is no configuration: it must be sections of keys and values, such as input:",
                       config.file.string());
  for (const std::string& set : sets) set_value(root, set);

  InputProblems problems;
  refuse_unknown_sections(root, table, problems.wrong);
  read_settings(root, folder, config, problems.wrong);
  const ConfigNode* input = root.find("input");
  if (input == nullptr)
    problems.wrong.push_back(fmt::format("{}: has no input: section", config.file.string()));
  else
    config.input = read_input_section(*input, folder, problems);

  for (const Stage& stage : table) {
    ConfiguredStage configured{&stage, stage.instantiate()};
    // A stage that this input does not need is checked all the same: a typo is a typo.
    if (const ConfigNode* section = root.find(stage.name); section != nullptr)
      assign_options(configured.instance.options, *section, stage.name, problems.wrong);
    if (stage.applies(config.input)) config.stages.push_back(std::move(configured));
  }
  if (!problems.wrong.empty()) {
    problems.wrong.insert(problems.wrong.end(), problems.missing.begin(), problems.missing.end());
    throw Error(ErrorCode::config, fmt::format("{}", fmt::join(problems.wrong, "\n")));
  }
  if (!problems.missing.empty())
    throw Error(ErrorCode::input, fmt::format("{}", fmt::join(problems.missing, "\n")));
  return config;
}

}  // namespace drape::pipeline
