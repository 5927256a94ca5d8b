// Pictures of what each stage made, for the report.
#pragma once

#include <vector>

#include "drape/pipeline/engine.hpp"
#include "drape/report/page.hpp"

namespace drape::stages {

/// Of the stage's result in `folder`, whose earlier stages lie beside it as links; empty for a stage that has
/// none.
[[nodiscard]] std::vector<report::Picture> stage_pictures(const std::string& stage,
                                                          const pipeline::Config& config,
                                                          const pipeline::RunResult& result);

}  // namespace drape::stages
