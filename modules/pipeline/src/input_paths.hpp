// File names in an `input:` section that is taken out of the file it stands in.
#pragma once

#include <filesystem>

#include "drape/pipeline/config_node.hpp"

namespace drape::pipeline {

/// Makes the files and patterns of root's `input` absolute, taken as relative to `folder`. What is no file
/// name is left as it is: reading the section complains of it.
void make_input_paths_absolute(ConfigNode& root, const std::filesystem::path& folder);

}  // namespace drape::pipeline
