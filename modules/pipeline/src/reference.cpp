#include "drape/pipeline/reference.hpp"

#include <fmt/format.h>

#include "drape/base/numbers.hpp"
#include "drape/pipeline/config.hpp"

namespace drape::pipeline {
namespace {

// A pipe would end a table's cell.
std::string cell(std::string text) {
  for (std::size_t i = 0; (i = text.find('|', i)) != std::string::npos; i += 2) text.insert(i, 1, '\\');
  return text;
}

std::string key_table(const std::string& prefix, const std::vector<InputKey>& keys) {
  std::string page = "| key | meaning |\n|---|---|\n";
  for (const InputKey& key : keys) page += fmt::format("| `{}{}` | {} |\n", prefix, key.name, cell(key.help));
  return page + "\n";
}

std::string values_of(const Option& option) {
  std::string text;
  switch (option.kind) {
    case OptionKind::flag:
      text = "true, false";
      break;
    case OptionKind::choice:
      text = fmt::format("{}", fmt::join(option.choices, ", "));
      break;
    case OptionKind::text:
      text = "text";
      break;
    case OptionKind::integer:
    case OptionKind::number:
    case OptionKind::numbers:
      if (option.kind == OptionKind::numbers)
        text = option.list_size == 0 ? "a list, each " : fmt::format("{} numbers, each ", option.list_size);
      if (option.range)
        text +=
            fmt::format("{} to {}", format_number(option.range->least), format_number(option.range->most));
      if (option.kind == OptionKind::integer) text += ", whole";
      break;
  }
  return option.may_be_unset ? text + ", or auto" : text;
}

std::string stage_section(const Stage& stage) {
  std::string page = fmt::format("## `{}`\n\n{}\n\n", stage.name, stage.summary);
  std::string reads;
  for (const std::string& part : stage.input_parts)
    reads += fmt::format("{}`input` ({})", reads.empty() ? "" : ", ", part);
  for (const Artifact& artifact : stage.reads)
    reads += fmt::format("{}`{}/{}`", reads.empty() ? "" : ", ", artifact.stage, artifact.pattern);
  std::string writes;
  for (const std::string& file : stage.writes)
    writes += fmt::format("{}`{}`", writes.empty() ? "" : ", ", file);
  page += fmt::format("Reads {}. Writes {}.\n\n", reads, writes);
  const Stage::Instance instance = stage.instantiate();
  if (instance.options.empty()) return page + "It has no options.\n\n";
  page += "| option | default | values | meaning |\n|---|---|---|---|\n";
  for (const Option& option : instance.options)
    page += fmt::format("| `{}` | `{}` | {} | {} |\n", option.name, readable(option.get()),
                        cell(values_of(option)), cell(option.help));
  return page + "\n";
}

}  // namespace

std::string reference_page(std::span<const Stage> table) {
  std::string page =
      "# Configuration reference\n\n"
      "Made by `drape reference` from the code; edits here are lost.\n\n"
      "A configuration is one YAML file. Each stage has a section of its name. On the command line,\n"
      "`--set section.key=value` takes the place of a value in the file. A unit is the suffix of a name: "
      "`_px` pixels,\n"
      "`_deg` degrees, `_percent`, `_m` metres, and `_spacings` multiples of the scans' median point spacing "
      "(for a given\n"
      "mesh: of its median edge length), so that one value serves a coin and a cathedral.\n\n"
      "## Top level\n\n";
  page += key_table("", top_level_keys());
  page += "## `input`\n\n" + key_table("", input_keys());
  page += "Each of `scans`, where it is no plain name:\n\n" + key_table("", scan_keys());
  page += "`depth`:\n\n" + key_table("", depth_keys());
  page += "Each of `photos`:\n\n" + key_table("", photo_keys());
  page += "Each of a photo's `strokes`:\n\n" + key_table("", stroke_keys());
  page += "A photo's `camera`:\n\n" + key_table("", photo_camera_keys());
  for (const Stage& stage : table) page += stage_section(stage);
  while (page.size() > 1 && page[page.size() - 2] == '\n') page.pop_back();
  return page;
}

}  // namespace drape::pipeline
