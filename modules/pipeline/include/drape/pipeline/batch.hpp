// Many objects, each a configuration of its own: a manifest's, or the points of an experiment.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "drape/pipeline/config.hpp"
#include "drape/pipeline/engine.hpp"
#include "drape/pipeline/job_pool.hpp"
#include "drape/pipeline/object_result.hpp"

namespace drape::pipeline {

struct BatchObject {
  std::string id;          // letters, digits, '.', '_', '-': it names folders
  ConfigNode root;         // its configuration; paths of its files are absolute
  std::string unreadable;  // why there is no configuration; empty: there is one
  // From here on filled in by plan_batch.
  std::string digest;                                       // of the configuration
  std::vector<std::pair<std::string, std::string>> inputs;  // file, SHA-256; may be left out
  double memory_mb = 0;                                     // that it is expected to take
  double seconds = 0;
  std::string problem;  // what is wrong with its configuration; empty: nothing
  int chunk = 0;
};

struct Batch {
  std::string name;
  std::filesystem::path source;     // manifest, absolute
  std::filesystem::path workspace;  // absolute
  std::filesystem::path output;  // absolute; each object's model goes to a folder of its id. Empty: nowhere
  std::string kind = "batches";  // folder of the workspace that its records lie in; "sweeps"
  std::vector<BatchObject> objects;

  [[nodiscard]] std::filesystem::path folder() const { return workspace / kind / name; }
  [[nodiscard]] std::filesystem::path result_file(const std::string& id) const {
    return folder() / "results" / (id + ".json");
  }
  [[nodiscard]] std::string run_name(const std::string& id) const { return name + "/" + id; }
};

/// The configuration of one object.
[[nodiscard]] Config object_config(const Batch& batch, const BatchObject& object,
                                   std::span<const Stage> table);

/// Checks every object's configuration, and estimates its time and memory: by its last result, else by the
/// size of its files. With `digests` the files' digests are taken too.
void plan_batch(Batch& batch, std::span<const Stage> table, bool digests);

struct BatchRunOptions {
  PoolOptions pool;
  JobLimits limits;          // of each object
  int threads = 0;           // of each object; 0: one per core
  bool last_attempt = true;  // record failures that may pass, too; else they are left for another attempt
  std::string command;
  std::vector<std::pair<std::string, std::string>> versions;
  /// Runs in the object's process after its run, for the report.
  std::function<void(const Config&, const RunResult&)> after_run;
  /// Called in this process as each object ends; `result` is as recorded.
  std::function<void(const ObjectResult& result)> ended;
};

/// Runs the objects, each in a process of its own under the limits, and writes one result record for each:
/// whatever happens to one, the others run. Returns how many were left for another attempt. Objects start in
/// the order given.
std::size_t run_objects(const Batch& batch, std::span<const BatchObject* const> objects,
                        std::span<const Stage> table, const BatchRunOptions& options);

/// All objects, those first that are expected to take longest.
[[nodiscard]] std::vector<const BatchObject*> longest_first(const Batch& batch);

}  // namespace drape::pipeline
