// A batch frozen into files, so that any machine that sees the workspace can do a part of it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drape/pipeline/batch.hpp"

namespace drape::pipeline {

/// Chunks of objects that need about as much memory.
struct MemoryClass {
  double memory_mb = 0;  // that each of its objects is expected to stay under: a power of two of GiB
  int first_chunk = 0;
  int chunks = 0;
  double longest_chunk_seconds = 0;  // expected
};

struct BatchPlan {
  Batch batch;
  std::vector<MemoryClass> classes;
};

/// Deals the objects of a planned batch out to chunks of at most `objects_per_chunk`, longest first within
/// each memory class, and writes plan.json and plan.jsonl (a line per object) to the batch's folder.
BatchPlan write_plan(Batch batch, int objects_per_chunk);

/// Reads a plan: the batch's folder, or its plan.json. Error{config} if there is none, or it is damaged.
[[nodiscard]] BatchPlan read_plan(const std::filesystem::path& where);

/// Where the plan of a manifest's batch lies.
[[nodiscard]] bool is_plan(const std::filesystem::path& where);

[[nodiscard]] std::vector<const BatchObject*> objects_of_chunk(const BatchPlan& plan, int chunk);

}  // namespace drape::pipeline
