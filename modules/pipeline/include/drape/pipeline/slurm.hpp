// Job arrays of Slurm (sbatch) for a planned batch.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "drape/pipeline/batch_plan.hpp"

namespace drape::pipeline {

struct SlurmOptions {
  std::string program;                   // absolute path of drape, the same on all nodes
  int tasks_at_once = 0;                 // of an array; 0: as many as there is room for
  int threads = 1;                       // per task
  double minutes = 0;                    // of a task; 0: ten times what is expected, an hour at least
  std::vector<std::string> sbatch_args;  // handed on: partition, account, ...
};

/// An sbatch command: the arguments without the program's name, and the script that it reads from its input.
struct SlurmJob {
  std::vector<std::string> arguments;
  std::string script;
};

/// One array per memory class, split where it has more than 1,000 tasks (Slurm's MaxArraySize is 1001 unless
/// it is set). Only chunks in `chunks` are sent; classes without any are left out.
[[nodiscard]] std::vector<SlurmJob> slurm_arrays(const BatchPlan& plan, const std::set<int>& chunks,
                                                 const SlurmOptions& options);

/// Runs sbatch; returns the job's number. Error{try_again} with what sbatch says if it refuses.
[[nodiscard]] std::string submit(const SlurmJob& job);

}  // namespace drape::pipeline
