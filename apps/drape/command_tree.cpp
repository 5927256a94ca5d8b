#include "command_tree.hpp"

#include <CLI/CLI.hpp>

#include "drape/stages/stage_table.hpp"

namespace drape::app {
namespace {

CommandOption described(const CLI::Option& option) {
  CommandOption described;
  described.positional = option.get_positional();
  if (described.positional) described.names = {option.get_name(true)};
  for (const std::string& name : option.get_snames()) described.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) described.names.push_back("--" + name);
  if (option.get_items_expected_max() > 0) described.value = option.get_type_name();
  described.help = option.get_description();
  described.required = option.get_required();
  described.repeats = option.get_expected_max() > 1;
  return described;
}

void add(const CLI::App& app, std::vector<std::string> path, std::vector<CommandNode>& tree) {
  CommandNode node;
  node.path = path;
  node.summary = app.get_description();
  node.example = app.get_footer();
  for (const CLI::Option* option : app.get_options({})) node.options.push_back(described(*option));
  tree.push_back(std::move(node));
  for (const CLI::App* sub : app.get_subcommands({})) {
    path.push_back(sub->get_name());
    add(*sub, path, tree);
    path.pop_back();
  }
}

}  // namespace

std::vector<CommandNode> command_tree(const CLI::App& app) {
  std::vector<CommandNode> tree;
  add(app, {}, tree);
  return tree;
}

ValueWords value_words() {
  ValueWords words;
  words["MODE"] = {"auto", "plain", "json"};
  words["SHELL"] = {"bash", "zsh"};
  for (const pipeline::Stage& stage : stages::stage_table()) {
    words["STAGE"].push_back(stage.name);
    for (const Option& option : stage.instantiate().options) {
      words["KEY=VALUE"].push_back(stage.name + "." + option.name + "=");
      if (stage.name == "segment" && option.name == "method") words["METHOD"] = option.choices;
      if (stage.name == "align" && option.name == "evidence") words["EVIDENCE"] = option.choices;
    }
  }
  return words;
}

}  // namespace drape::app
