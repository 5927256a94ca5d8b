// Experiments: one configuration, many settings, one table.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "drape/pipeline/batch.hpp"

namespace drape::pipeline {

/// The points of the `sweep:` section of a configuration, as a batch that publishes nothing:
///   objects: [a.yaml, b.yaml]   configurations; what this one says in its other sections is laid over each.
///                               Without it: this configuration itself
///   seeds: [1, 2] or repeats: 3  (seeds 1..3)
///   grid: {align.first_pass_step_deg: [45, 20], mesh.method: [poisson, grid]}   every combination
///   list: [{fill.base: flat}, {fill.base: leave, name: open}]                   one after the other, each
///   with
///                               every combination of the grid
struct Sweep {
  Batch batch;                                   // ids 001, 002, ...
  std::vector<std::string> names;                // of what varies: "object", "seed", option names
  std::vector<std::vector<std::string>> values;  // of each point, one per name
};
/// Error{config} naming the place; also for more than 10,000 points, and for a configuration without sweep.
[[nodiscard]] Sweep read_sweep(const std::filesystem::path& config, std::span<const std::string> sets);

/// What the points gave, a row each: point, what varies, status, seconds, peak_memory_mb, then
/// <stage>.seconds and <stage>.<metric> of every stage that any point has. Numbers as text; empty where a
/// point has no such value. A stage's seconds are those of making its result, also where it was reused.
struct SweepTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
  std::size_t varied = 0;  // columns 1 .. varied are what varies
};
[[nodiscard]] SweepTable sweep_table(const Sweep& sweep);

/// table.csv and table.json in the sweep's folder.
void write_sweep_table(const Sweep& sweep, const SweepTable& table);

}  // namespace drape::pipeline
