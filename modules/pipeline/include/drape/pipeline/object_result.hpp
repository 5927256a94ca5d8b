// What became of one object of a batch: results/<id>.json, the only thing that a batch's state is told from.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace drape::pipeline {

struct ObjectResult {
  std::string id;
  std::string status;         // ok, review, failed
  std::string error;          // class: config, input, bug, io, try_again, memory, timeout, crash; empty: none
  std::string message;        // of the error, or why it needs review
  std::string stage;          // that failed
  std::string config_digest;  // of what it was made from
  std::vector<std::string> ran;  // stages that were made, not reused
  double seconds = 0;            // wall time of its process
  double stage_seconds = 0;      // of which its stages took
  double peak_memory_mb = 0;
  std::string host;
  std::string finished_at;                                 // ISO 8601, UTC
  std::vector<std::pair<std::string, std::string>> files;  // published: name, SHA-256
};

void write_object_result(const std::filesystem::path& file, const ObjectResult& result);
/// Nothing if there is none or it is damaged.
[[nodiscard]] std::optional<ObjectResult> read_object_result(const std::filesystem::path& file);

struct Batch;

/// Adds up: ok + review + failed + missing = objects.
struct BatchSummary {
  std::size_t objects = 0;
  std::size_t ok = 0;
  std::size_t review = 0;
  std::size_t failed = 0;
  std::size_t missing = 0;            // no result, or one of another configuration
  std::vector<ObjectResult> results;  // failed first, then review, then ok; each by id
  std::vector<std::string> missing_ids;

  [[nodiscard]] bool complete() const { return failed == 0 && missing == 0; }
};
/// Reads the result records of the batch's objects, and nothing else.
[[nodiscard]] BatchSummary summarize(const Batch& batch);
/// summary.json in the batch's folder.
void write_summary(const Batch& batch, const BatchSummary& summary);

}  // namespace drape::pipeline
