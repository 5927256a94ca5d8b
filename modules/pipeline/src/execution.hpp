// What a running stage sees of the engine.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "drape/pipeline/config.hpp"
#include "drape/pipeline/records.hpp"
#include "drape/pipeline/workspace.hpp"

namespace drape::pipeline {

using Results = std::map<std::string, StageRecord>;  // of the stages so far

/// Keeps a stage to what its row names: it reads committed files of its `reads`, and writes its `writes` into
/// `folder`.
class Execution : public StageRun {
 public:
  Execution(const Stage& stage, const Config& config, const Workspace& workspace, const Results& results,
            std::filesystem::path folder, Progress progress)
      : stage_(stage),
        config_(config),
        workspace_(workspace),
        results_(results),
        folder_(std::move(folder)),
        progress_(std::move(progress)) {}

  [[nodiscard]] const Input& input() const override { return config_.input; }
  [[nodiscard]] std::filesystem::path artifact(std::string_view stage, std::string_view file) const override;
  [[nodiscard]] bool has_artifact(std::string_view stage, std::string_view file) const override;
  [[nodiscard]] std::filesystem::path output(std::string_view file) override;
  [[nodiscard]] const Progress& progress() const override { return progress_; }
  [[nodiscard]] std::uint64_t seed() const override { return config_.seed; }
  void metric(std::string name, std::variant<double, std::string> value) override {
    metrics.emplace_back(std::move(name), std::move(value));
  }
  void needs_review(std::string reason) override { review_reasons.push_back(std::move(reason)); }

  std::vector<Metric> metrics;
  std::vector<std::string> review_reasons;

 private:
  const Stage& stage_;
  const Config& config_;
  const Workspace& workspace_;
  const Results& results_;
  std::filesystem::path folder_;
  Progress progress_;
};

}  // namespace drape::pipeline
