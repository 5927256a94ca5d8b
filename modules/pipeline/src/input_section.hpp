// Reading the `input:` section of a configuration.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drape/pipeline/config.hpp"

namespace drape::pipeline {

struct InputProblems {
  std::vector<std::string> wrong;    // the configuration says something it may not
  std::vector<std::string> missing;  // it names files that are not there
};

/// Paths are relative to `folder`; patterns are expanded, sorted within each.
[[nodiscard]] Input read_input_section(const ConfigNode& node, const std::filesystem::path& folder,
                                       InputProblems& problems);

/// The line for a key that does not exist, with the likely one.
[[nodiscard]] std::string unknown_key(const ConfigNode::Key& key, const std::string& section,
                                      const std::vector<std::string>& names);

}  // namespace drape::pipeline
