// A configuration: what a YAML file and the command line ask for, checked as a whole before anything runs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "drape/pipeline/config_node.hpp"
#include "drape/pipeline/input.hpp"
#include "drape/pipeline/stage.hpp"

namespace drape::pipeline {

/// One stage of the table with its options set.
struct ConfiguredStage {
  const Stage* stage = nullptr;  // in the table that load_config was given
  Stage::Instance instance;
};

struct Config {
  std::string name;                 // stem of the file
  std::filesystem::path file;       // absolute
  std::string text;                 // of the file
  std::vector<std::string> sets;    // key=value from the command line
  Input input;                      // absolute paths
  std::filesystem::path workspace;  // absolute
  std::filesystem::path output;     // absolute; where export's files are copied
  std::uint64_t seed = 1;
  std::vector<ConfiguredStage> stages;  // those that apply to this input, in the table's order
};

/// Reads and checks everything at once: every problem is reported, each as
///   file:line:column: key = value: what is wrong (what the key means)
/// Error{config}; Error{input} where nothing is wrong but that files named in `input` do not exist.
[[nodiscard]] Config load_config(const std::filesystem::path& file, std::span<const Stage> table,
                                 std::span<const std::string> sets);

/// A configuration that is no file of its own, such as one object of a batch.
struct ConfigSource {
  std::string name;
  std::filesystem::path file;  // absolute; what messages and records name
  std::string text;            // for the record
  ConfigNode root;             // a map
};
/// The same for a tree. Paths are relative to the folder of `source.file`.
[[nodiscard]] Config configure(ConfigSource source, std::span<const Stage> table,
                               std::span<const std::string> sets);

/// Gives the options what a map node says. Adds a line to `problems` for each unknown key and each wrong
/// value; `section` names the keys in them ("fill" for fill.base).
void assign_options(const std::vector<Option>& options, const ConfigNode& section_node,
                    const std::string& section, std::vector<std::string>& problems);

/// A key of `input:`, for the reference page and for "did you mean".
struct InputKey {
  std::string name;
  std::string help;
};
[[nodiscard]] const std::vector<InputKey>& input_keys();
[[nodiscard]] const std::vector<InputKey>& photo_keys();
[[nodiscard]] const std::vector<InputKey>& scan_keys();
[[nodiscard]] const std::vector<InputKey>& depth_keys();
[[nodiscard]] const std::vector<InputKey>& photo_camera_keys();
[[nodiscard]] const std::vector<InputKey>& stroke_keys();
[[nodiscard]] const std::vector<InputKey>& top_level_keys();

}  // namespace drape::pipeline
