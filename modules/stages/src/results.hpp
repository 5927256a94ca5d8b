// Paths of results within a finished run.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "drape/pipeline/engine.hpp"

namespace drape::stages {

class Results {
 public:
  Results(const pipeline::Config& config, const pipeline::RunResult& result);

  /// Empty if the run has no such stage.
  [[nodiscard]] std::filesystem::path file(const std::string& stage, const std::string& name) const;
  [[nodiscard]] const pipeline::Config& config() const { return config_; }

 private:
  const pipeline::Config& config_;
  std::vector<std::pair<std::string, std::filesystem::path>> folders_;
};

}  // namespace drape::stages
