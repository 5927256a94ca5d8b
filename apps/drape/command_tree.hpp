// The command line as data, for what is generated from it: shell completion and the manual page.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace drape::app {

struct CommandOption {
  std::vector<std::string> names;  // with their dashes; a positional's name without
  std::string value;               // what stands for the value, such as FILE; empty: a flag
  std::string help;
  bool positional = false;
  bool required = false;
  bool repeats = false;
};

struct CommandNode {
  std::vector<std::string> path;  // {"batch", "run"}; empty for the program itself
  std::string summary;
  std::string example;
  std::vector<CommandOption> options;
};

/// The program itself first, then each command in the order in which it was added, a group before its
/// members.
[[nodiscard]] std::vector<CommandNode> command_tree(const CLI::App& app);

/// Words that a value may be, by what stands for it ("STAGE" -> ingest, register, ...).
using ValueWords = std::map<std::string, std::vector<std::string>>;
[[nodiscard]] ValueWords value_words();

/// A function for bash, and for zsh by its bashcompinit, that completes commands, options and their values;
/// files elsewhere.
[[nodiscard]] std::string bash_completion(const std::vector<CommandNode>& tree, const ValueWords& words);
[[nodiscard]] std::string zsh_completion(const std::vector<CommandNode>& tree, const ValueWords& words);

/// drape(1) in the man macros (man(7)): every command with its options, every option of a configuration.
[[nodiscard]] std::string manual_page(const std::vector<CommandNode>& tree);

}  // namespace drape::app
