#include "results.hpp"

#include <fmt/core.h>

namespace drape::stages {

Results::Results(const pipeline::Config& config, const pipeline::RunResult& result) : config_(config) {
  for (std::size_t i = 0; i < result.record.stages.size(); ++i)
    folders_.emplace_back(result.record.stages[i].stage,
                          result.folder / fmt::format("{}-{}", i + 1, result.record.stages[i].stage));
}

std::filesystem::path Results::file(const std::string& stage, const std::string& name) const {
  for (const auto& [known, folder] : folders_)
    if (known == stage) return folder / name;
  return {};
}

}  // namespace drape::stages
