// report.html of a run, made from its record and its results.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "drape/pipeline/engine.hpp"

namespace drape::stages {

/// Writes runs/<name>/report.html and returns its path. Where nothing ran and the page is there, it is left
/// as it is.
std::filesystem::path write_run_report(const pipeline::Config& config, const pipeline::RunResult& result,
                                       const std::vector<std::pair<std::string, std::string>>& versions);

}  // namespace drape::stages
