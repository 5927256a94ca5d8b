#include "slurm_cluster.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "drape/base/files.hpp"

namespace drape::test {
namespace fs = std::filesystem;
namespace {

void pause_briefly() {
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
}

// Ports of slurmctld and slurmd: two of the range that this process number picks, so that test runs at the
// same time do not meet.
int first_port() {
  constexpr int lowest = 20000;
  constexpr int pairs = 5000;
  return lowest + 2 * (static_cast<int>(::getpid()) % pairs);
}

}  // namespace

ShellOutcome run_shell(const std::string& line) {
  ShellOutcome outcome;
  std::FILE* pipe = ::popen(("{ " + line + "; } 2>&1").c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 4096> buffer{};
  for (std::size_t count = 0; (count = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    outcome.out.append(buffer.data(), count);
  const int status = ::pclose(pipe);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome;
}

bool SlurmCluster::installed() {
  return run_shell("PATH=$PATH:/usr/sbin; command -v munged slurmctld slurmd sbatch squeue sinfo scancel")
             .exit_code == 0;
}

SlurmCluster::SlurmCluster(fs::path folder) : folder_(std::move(folder)) {
  for (const char* name : {"state", "spool", "run"}) fs::create_directories(folder_ / name);
  write_configuration();
  ::setenv("SLURM_CONF", (folder_ / "slurm.conf").c_str(), 1);
  const ShellOutcome started = run_shell(fmt::format(
      "cd '{}' && PATH=$PATH:/usr/sbin && head -c 1024 /dev/urandom >munge.key && chmod 400 munge.key && "
      "munged --force --key-file=$PWD/munge.key --socket=$PWD/run/munge.sock --pid-file=$PWD/run/munged.pid "
      "--log-file=$PWD/munged.log --seed-file=$PWD/munge.seed && slurmctld && slurmd",
      folder_.string()));
  constexpr int most_waits = 200;
  for (int i = 0; i < most_waits && started.exit_code == 0; ++i, pause_briefly())
    if (run_shell("sinfo -h -o %T").out.find("idle") != std::string::npos) return;
  const std::string logs = run_shell("tail -n 20 '" + folder_.string() + "'/*.log").out;
  stop();
  throw std::runtime_error("the Slurm cluster did not start: " + started.out + logs);
}

SlurmCluster::~SlurmCluster() {
  stop();
  ::unsetenv("SLURM_CONF");
}

void SlurmCluster::stop() const {
  static_cast<void>(run_shell("scancel --user=$(id -un)"));
  for (const char* daemon : {"slurmd", "slurmctld", "munged"})
    static_cast<void>(
        run_shell(fmt::format("pid=$(cat '{}/run/{}.pid') && kill $pid && for i in $(seq 50); do kill -0 "
                              "$pid || break; sleep 0.1; done",
                              folder_.string(), daemon)));
}

bool SlurmCluster::wait_until_empty(double seconds) const {
  const auto begin = std::chrono::steady_clock::now();
  while (std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() < seconds) {
    const ShellOutcome queue = run_shell("squeue -h -o %i");
    if (queue.exit_code == 0 && queue.out.empty()) return true;
    pause_briefly();
  }
  return false;
}

void SlurmCluster::write_configuration() const {
  const std::string text = R"(ClusterName=drape
SlurmctldHost=HOST(127.0.0.1)
SlurmUser=USER
SlurmdUser=USER
SlurmctldPort=CONTROLLER_PORT
SlurmdPort=NODE_PORT
AuthType=auth/munge
AuthInfo=socket=FOLDER/run/munge.sock
CredType=cred/munge
StateSaveLocation=FOLDER/state
SlurmdSpoolDir=FOLDER/spool
SlurmctldPidFile=FOLDER/run/slurmctld.pid
SlurmdPidFile=FOLDER/run/slurmd.pid
SlurmctldLogFile=FOLDER/slurmctld.log
SlurmdLogFile=FOLDER/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
RequeueExit=75
SchedulerParameters=batch_sched_delay=0
NodeName=HOST NodeAddr=127.0.0.1 CPUs=2 RealMemory=8000 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
)";
  write_file(folder_ / "slurm.conf", text);
  const ShellOutcome filled = run_shell(fmt::format(
      "sed -i -e \"s/HOST/$(hostname -s)/; s/USER/$(id -un)/; s/CONTROLLER_PORT/{}/; s/NODE_PORT/{}/\" "
      "-e 's|FOLDER|{}|' '{}'",
      first_port(), first_port() + 1, folder_.string(), (folder_ / "slurm.conf").string()));
  if (filled.exit_code != 0) throw std::runtime_error("slurm.conf: " + filled.out);
}

}  // namespace drape::test
