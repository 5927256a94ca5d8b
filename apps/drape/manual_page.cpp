#include <fmt/format.h>

#include "command_tree.hpp"
#include "commands.hpp"
#include "drape/stages/stage_table.hpp"

namespace drape::app {
namespace {

// Text as roff takes it: backslashes, dashes that are to stay dashes, and dots and quotes at the start of a
// line.
std::string roff(const std::string& text) {
  std::string escaped;
  bool line_start = true;
  for (const char c : text) {
    if (line_start && (c == '.' || c == '\'')) escaped += "\\&";
    line_start = c == '\n';
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string usage(const CommandNode& node) {
  std::string text = "drape";
  for (const std::string& word : node.path) text += " " + word;
  for (const CommandOption& option : node.options) {
    if (!option.positional) continue;
    const std::string name = option.value.empty() ? option.names.front() : option.value;
    const std::string word = option.repeats ? name + "..." : name;
    text += option.required ? " " + word : " [" + word + "]";
  }
  return text;
}

std::string option_entry(const CommandOption& option) {
  std::string names;
  for (const std::string& name : option.names)
    names += fmt::format("{}\\fB{}\\fR", names.empty() ? "" : ", ", roff(name));
  if (!option.value.empty()) names += fmt::format(" \\fI{}\\fR", roff(option.value));
  return fmt::format(".TP\n{}\n{}\n", names, roff(option.help));
}

std::string command_section(const CommandNode& node) {
  std::string text = fmt::format(".SS {}\n{}.\n", roff(usage(node)), roff(node.summary));
  for (const CommandOption& option : node.options) {
    const bool help = !option.names.empty() && option.names.back() == "--help";
    if (!option.positional && !help) text += option_entry(option);
  }
  return text;
}

std::string configuration_section() {
  std::string text =
      ".SH CONFIGURATION\nA YAML file with the sections \\fBinput\\fR, \\fBworkspace\\fR, \\fBoutput\\fR, "
      "\\fBseed\\fR "
      "and one section per stage. Each option may also be given as \\fB\\-\\-set\\fR "
      "\\fIstage.option=value\\fR.\n";
  for (const pipeline::Stage& stage : stages::stage_table()) {
    text += fmt::format(".SS {}\n{}\n", roff(stage.name), roff(stage.summary));
    for (const Option& option : stage.instantiate().options)
      text += fmt::format(".TP\n\\fB{}\\fR (default: {})\n{}\n", roff(option.name),
                          roff(readable(option.get())), roff(option.help));
  }
  return text;
}

}  // namespace

std::string manual_page(const std::vector<CommandNode>& tree) {
  std::string text =
      fmt::format(".TH DRAPE 1 \"\" \"drape {}\" \"User Commands\"\n", versions().front().second);
  text +=
      ".SH NAME\ndrape \\- range scans and photos to a textured 3D model, unattended\n"
      ".SH SYNOPSIS\n.B drape\n[\\fIOPTIONS\\fR] \\fICOMMAND\\fR ...\n"
      ".SH DESCRIPTION\nTurns raw laser range scans and ordinary, uncalibrated photos into a textured 3D "
      "model: registers "
      "the scans, meshes them, fills the holes, finds the object in each photo, finds the camera by matching "
      "outlines, and "
      "puts the photo on the mesh. Each stage keeps its result and runs again only if something that it "
      "depends on has "
      "changed.\n.SH OPTIONS\n";
  for (const CommandOption& option : tree.front().options) text += option_entry(option);
  text += ".SH COMMANDS\n";
  for (std::size_t i = 1; i < tree.size(); ++i) text += command_section(tree[i]);
  text += configuration_section();
  text +=
      ".SH EXIT STATUS\n.TP\n0\nDone; the run may still ask for a review, and says so.\n.TP\n1\nSome objects "
      "of a batch "
      "failed or are missing.\n.TP\n64\nThe command line or the configuration is wrong.\n.TP\n65\nAn input "
      "file is missing, "
      "damaged or makes no sense.\n.TP\n70\nA bug of drape.\n.TP\n74\nWriting failed: disk full, no "
      "permission.\n.TP\n75\n"
      "Something is busy or out of memory; the same call may work later.\n.TP\n130, 143\nInterrupted; what "
      "was finished is "
      "kept.\n.SH EXAMPLES\n.nf\n";
  for (const CommandNode& node : tree) {
    const std::size_t line = node.example.find("\n  ");
    if (!node.path.empty() && line != std::string::npos) text += roff(node.example.substr(line + 3)) + "\n";
  }
  return text + ".fi\n";
}

}  // namespace drape::app
