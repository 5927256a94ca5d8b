// What is written down about stage results and runs: stage.json and run.json.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "drape/pipeline/key.hpp"
#include "drape/pipeline/stage.hpp"

namespace drape::pipeline {

struct StageFile {
  std::string name;  // relative to the result's folder
  std::string digest;
  std::uint64_t bytes = 0;
};

/// stage.json: written last, so that a folder with one is a whole result.
struct StageRecord {
  std::string stage;
  std::string key;
  std::vector<KeyPart> parts;
  std::vector<StageFile> files;
  // From here on nothing takes part in a key or a digest.
  double seconds = 0;
  double peak_memory_mb = 0;
  std::string made_at;  // ISO 8601, UTC
  std::vector<std::pair<std::string, std::string>> versions;
  std::vector<Metric> metrics;
  std::vector<std::string> warnings;
  std::vector<std::string> review_reasons;
};

void write_stage_record(const std::filesystem::path& file, const StageRecord& record);
/// Nothing if there is none or it is damaged.
[[nodiscard]] std::optional<StageRecord> read_stage_record(const std::filesystem::path& file);

struct RunStage {
  std::string stage;
  std::string key;
  bool ran = false;    // made in this run; else reused
  double seconds = 0;  // that this run spent on it
};

/// run.json
struct RunRecord {
  std::string name;
  std::string config_file;
  std::string config_text;
  std::vector<std::string> sets;
  std::string command;
  std::string output;
  std::string started_at;  // ISO 8601, UTC
  double seconds = 0;
  std::string status;  // ok, review, failed, interrupted, running
  std::vector<std::string> reasons;
  std::vector<RunStage> stages;
};

void write_run_record(const std::filesystem::path& file, const RunRecord& record);
[[nodiscard]] std::optional<RunRecord> read_run_record(const std::filesystem::path& file);

/// Now, as "2026-01-31T12:00:00Z".
[[nodiscard]] std::string utc_now();

}  // namespace drape::pipeline
