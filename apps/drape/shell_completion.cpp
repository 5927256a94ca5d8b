#include <fmt/format.h>

#include <algorithm>

#include "command_tree.hpp"

namespace drape::app {
namespace {

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, " "));
}

// "batch run": what the words of the command line so far are matched with.
std::string path_text(const CommandNode& node) {
  return joined(node.path);
}

std::string members_of(const CommandNode& group, const std::vector<CommandNode>& tree) {
  std::vector<std::string> names;
  for (const CommandNode& node : tree)
    if (node.path.size() == group.path.size() + 1 &&
        std::equal(group.path.begin(), group.path.end(), node.path.begin()))
      names.push_back(node.path.back());
  return joined(names);
}

std::string option_names(const CommandNode& node) {
  std::vector<std::string> names;
  for (const CommandOption& option : node.options)
    if (!option.positional) names.insert(names.end(), option.names.begin(), option.names.end());
  return joined(names);
}

// case labels of options (of any command) with this value: "--from|--until|--only"
std::string options_with(const std::string& value, const std::vector<CommandNode>& tree) {
  std::vector<std::string> names;
  for (const CommandNode& node : tree)
    for (const CommandOption& option : node.options)
      if (!option.positional && option.value == value)
        for (const std::string& name : option.names)
          if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return fmt::format("{}", fmt::join(names, "|"));
}

std::string value_cases(const std::vector<CommandNode>& tree, const ValueWords& words) {
  std::string text;
  for (const auto& [value, list] : words) {
    const std::string names = options_with(value, tree);
    if (names.empty()) continue;
    // No space after "fill.base=": its value follows.
    const bool open = list.front().back() == '=';
    text += fmt::format("    {})\n{}      COMPREPLY=($(compgen -W \"{}\" -- \"$word\"))\n      return ;;\n",
                        names, open ? "      type compopt >/dev/null 2>&1 && compopt -o nospace\n" : "",
                        joined(list));
  }
  return text;
}

// Options that take a value which is a file or anything else: the shell's own completion serves.
std::string other_value_case(const std::vector<CommandNode>& tree, const ValueWords& words) {
  std::vector<std::string> names;
  for (const CommandNode& node : tree)
    for (const CommandOption& option : node.options)
      if (!option.positional && !option.value.empty() && words.count(option.value) == 0)
        for (const std::string& name : option.names)
          if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names.empty() ? "" : fmt::format("    {}) return ;;\n", fmt::join(names, "|"));
}

// Positionals with a set of words, by command.
std::string positional_cases(const std::vector<CommandNode>& tree, const ValueWords& words) {
  std::string text;
  for (const CommandNode& node : tree) {
    std::string members = members_of(node, tree);
    for (const CommandOption& option : node.options)
      if (option.positional && words.count(option.value) != 0)
        members += (members.empty() ? "" : " ") + joined(words.at(option.value));
    text += fmt::format("    \"{}\") names=\"{}\"; options=\"{}\" ;;\n", path_text(node), members,
                        option_names(node));
  }
  return text;
}

}  // namespace

std::string bash_completion(const std::vector<CommandNode>& tree, const ValueWords& words) {
  std::string groups;
  for (const CommandNode& node : tree)
    if (!node.path.empty()) groups += fmt::format("\"{}\"|", path_text(node));
  groups.pop_back();
  return fmt::format(R"(# Completion of drape for bash; made by: drape completion bash
_drape() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} path= names= options= one i
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; i++)); do
    one="${{path:+$path }}${{COMP_WORDS[i]}}"
    case "$one" in
    {}) path=$one ;;
    esac
  done
  case "$before" in
{}{}  esac
  case "$path" in
{}  esac
  case "$word" in
    -*) COMPREPLY=($(compgen -W "$options {}" -- "$word")) ;;
    *) COMPREPLY=($(compgen -W "$names" -- "$word")) ;;
  esac
}}
complete -o bashdefault -o default -F _drape drape
)",
                     groups, value_cases(tree, words), other_value_case(tree, words),
                     positional_cases(tree, words), option_names(tree.front()));
}

std::string zsh_completion(const std::vector<CommandNode>& tree, const ValueWords& words) {
  return "#compdef drape\nautoload -U +X bashcompinit && bashcompinit\n" + bash_completion(tree, words) +
         "_bash_complete -o bashdefault -o default -F _drape drape\n";
}

}  // namespace drape::app
