// Pages that set runs beside one another.
#pragma once

#include <filesystem>

#include "drape/pipeline/sweep.hpp"
#include "drape/pipeline/workspace.hpp"

namespace drape::stages {

/// report.html in the sweep's folder: the table, plots of the quality over what varies and over time, and
/// pictures of every point. Returns it.
std::filesystem::path write_sweep_report(const pipeline::Sweep& sweep, const pipeline::SweepTable& table);

/// A run to compare: its record and the workspace that holds its results.
struct ComparedRun {
  pipeline::Workspace workspace;
  pipeline::RunRecord record;
};

/// Differences of two runs: options and files, metrics and times, and their pictures side by side. Returns
/// how many options or files differ.
std::size_t write_run_comparison(const ComparedRun& a, const ComparedRun& b,
                                 const std::filesystem::path& file);

}  // namespace drape::stages
