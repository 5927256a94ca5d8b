// What `drape batch ...` and `drape sweep` do. Each returns the exit code: 1 where some objects failed.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "drape/pipeline/batch.hpp"

namespace drape::app {

struct BatchArguments {
  std::filesystem::path manifest;  // YAML, CSV, a folder of objects, or a plan
  std::filesystem::path fixes;     // of apply
  std::vector<std::string> sets;   // of sweep
  std::optional<std::filesystem::path> workspace;
  std::optional<std::filesystem::path> output;
  int jobs = 1;
  double memory_mb = 0;         // that all objects together may take; 0: what is free
  double object_memory_mb = 0;  // limits of each object; 0: none
  double object_seconds = 0;
  double object_cpu_seconds = 0;
  bool retry_failed = false;
  int chunk = 0;        // of worker
  int chunk_size = 20;  // objects per chunk, of plan
  double task_minutes = 0;
  int threads = 0;
  std::vector<std::string> sbatch_args;
  bool dry_run = false;
  bool quiet = false;
  std::string command;  // the command line as it was typed
};

/// What the command line asks for. An object has as many threads as --threads says, else the cores divided
/// among the objects that run at once.
[[nodiscard]] pipeline::BatchRunOptions run_options(const BatchArguments& arguments,
                                                    const std::atomic<bool>& stop);

int batch_run_command(const BatchArguments& arguments, const std::atomic<bool>& stop);
int batch_plan_command(const BatchArguments& arguments);
int batch_worker_command(const BatchArguments& arguments, const std::atomic<bool>& stop);
int batch_submit_command(const BatchArguments& arguments);
int batch_status_command(const BatchArguments& arguments);
int batch_apply_command(const BatchArguments& arguments, const std::atomic<bool>& stop);
int sweep_command(const BatchArguments& arguments, const std::atomic<bool>& stop);

}  // namespace drape::app
