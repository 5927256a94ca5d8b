// The stages of drape, in the order in which they run.
#pragma once

#include <vector>

#include "drape/pipeline/stage.hpp"

namespace drape::stages {

/// ingest, register, mesh, fill, segment, align, texture, export. A YAML section, a stage's name, and the
/// file src/<name>_stage.cpp are the same word.
[[nodiscard]] std::vector<pipeline::Stage> stage_table();

}  // namespace drape::stages
