// Work in child processes: what one of them does to itself does not touch the others.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>

namespace drape::pipeline {

/// 0: no limit.
struct JobLimits {
  double wall_seconds = 0;
  double cpu_seconds = 0;
  double memory_mb = 0;  // of address space (RLIMIT_AS)
};

struct Job {
  std::function<int()> work;  // runs in the child; its value is the child's exit code
  double estimated_memory_mb = 0;
  JobLimits limits;
  std::filesystem::path log;  // the child's standard output and error; made anew
};

struct JobEnd {
  enum class How { exited, signalled, timed_out };
  How how = How::exited;
  int code = 0;  // exit code, or signal
  double seconds = 0;
};

struct PoolOptions {
  int at_once = 1;
  double memory_mb = 0;  // a job starts only while the estimates of all that run fit; 0: not looked at
  const std::atomic<bool>* stop = nullptr;
};

/// Runs every job in a child of its own, forked from this process: call it before anything in the process has
/// started a thread. Jobs start in their order, but one that does not fit into memory now lets later ones
/// pass; one that never fits runs alone. `ended` is called in this process for each, as it ends.
/// When `stop` is set, the children get SIGTERM, after 1.8 s SIGKILL, and Interrupted is thrown; `ended` is
/// not called for them. Children die with their parent. Error{try_again} if no process can be made.
void run_jobs(std::span<const Job> jobs, const PoolOptions& options,
              const std::function<void(std::size_t index, const JobEnd& end)>& ended);

/// Memory that processes can still get without swapping, in MB (10^6 bytes).
[[nodiscard]] double available_memory_mb();

}  // namespace drape::pipeline
