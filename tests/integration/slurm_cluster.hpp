// A Slurm cluster of one node on this machine, with its own keys, ports and folder, for as long as it is in
// scope.
#pragma once

#include <filesystem>
#include <string>

namespace drape::test {

struct ShellOutcome {
  int exit_code = -1;
  std::string out;  // what it printed, to stdout and stderr alike
};

/// Runs a line by /bin/sh.
[[nodiscard]] ShellOutcome run_shell(const std::string& line);

/// munged, slurmctld and slurmd, without systemd; SLURM_CONF names the cluster to sbatch and the like as long
/// as it lives. Two cores; a task that exits with 75 is sent again.
class SlurmCluster {
 public:
  /// Whether Slurm's and MUNGE's programs are installed.
  [[nodiscard]] static bool installed();

  /// Starts the daemons in `folder` and waits until the node is idle; std::runtime_error with their logs if
  /// it never is.
  explicit SlurmCluster(std::filesystem::path folder);
  ~SlurmCluster();
  SlurmCluster(const SlurmCluster&) = delete;
  SlurmCluster& operator=(const SlurmCluster&) = delete;

  /// Waits until no job is in the queue; false after `seconds`.
  [[nodiscard]] bool wait_until_empty(double seconds) const;

 private:
  void write_configuration() const;
  void stop() const;

  std::filesystem::path folder_;
};

}  // namespace drape::test
