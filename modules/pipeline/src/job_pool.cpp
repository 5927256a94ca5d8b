#include "drape/pipeline/job_pool.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "drape/base/error.hpp"

namespace drape::pipeline {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Running {
  std::size_t index = 0;
  pid_t process = 0;
  int handle = -1;  // a pidfd: poll() wakes when the process ends
  Clock::time_point start;
  bool timed_out = false;
};

// `grace`: how much further the limit is that cannot be caught; at the CPU's soft limit comes SIGXCPU, at the
// hard one SIGKILL, which would not say why.
void limit(__rlimit_resource what, double most, double per_unit, rlim_t grace) {
  if (most <= 0) return;
  const auto value = static_cast<rlim_t>(most * per_unit);
  const struct rlimit both { value, value + grace };
  ::setrlimit(what, &both);
}

[[noreturn]] void be_the_child(const Job& job, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // it died before the line above
  const int log = ::open(job.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (log >= 0) {
    ::dup2(log, STDOUT_FILENO);
    ::dup2(log, STDERR_FILENO);
    ::close(log);
  }
  limit(RLIMIT_AS, job.limits.memory_mb, 1e6, 0);
  limit(RLIMIT_CPU, job.limits.cpu_seconds, 1, 1);
  int code = 1;
  try {
    code = job.work();
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "drape: %s\n", failure.what());
  }
  std::fflush(nullptr);
  // Not exit(): what the parent registered to happen at its end is not the child's to do.
  ::_exit(code);
}

class Pool {
 public:
  Pool(std::span<const Job> jobs, const PoolOptions& options,
       const std::function<void(std::size_t, const JobEnd&)>& ended)
      : jobs_(jobs), options_(options), ended_(ended) {
    for (std::size_t i = 0; i < jobs.size(); ++i) waiting_.push_back(i);
  }
  ~Pool() {
    for (const Running& child : running_) {
      ::kill(child.process, SIGKILL);
      reap(child);
    }
  }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  void run() {
    while (!waiting_.empty() || !running_.empty()) {
      if (stopped()) end_all();
      start_what_fits();
      wait_a_while();
      collect();
    }
  }

 private:
  [[nodiscard]] bool stopped() const { return options_.stop != nullptr && *options_.stop; }

  [[nodiscard]] bool fits(std::size_t index) const {
    if (running_.empty() || options_.memory_mb <= 0) return true;
    double planned = jobs_[index].estimated_memory_mb;
    for (const Running& child : running_) planned += jobs_[child.index].estimated_memory_mb;
    return planned <= options_.memory_mb;
  }

  void start_what_fits() {
    auto next = waiting_.begin();
    while (next != waiting_.end() &&
           running_.size() < static_cast<std::size_t>(std::max(1, options_.at_once))) {
      if (!fits(*next)) {
        ++next;
        continue;
      }
      start(*next);
      next = waiting_.erase(next);
    }
  }

  void start(std::size_t index) {
    std::fflush(nullptr);  // or the child would write what is buffered a second time
    const pid_t parent = ::getpid();
    const pid_t process = ::fork();
    if (process == 0) be_the_child(jobs_[index], parent);
    if (process < 0)
      throw Error(ErrorCode::try_again, std::string("no process can be started: ") + std::strerror(errno));
    const auto handle = static_cast<int>(::syscall(SYS_pidfd_open, process, 0));
    running_.push_back({index, process, handle, Clock::now(), false});
  }

  // Until a child ends, a time-out is due, or a tenth of a second is over: then `stop` is looked at.
  void wait_a_while() {
    std::vector<pollfd> handles;
    bool all_have_handles = true;
    for (const Running& child : running_) {
      handles.push_back({child.handle, POLLIN, 0});
      all_have_handles = all_have_handles && child.handle >= 0;
    }
    ::poll(handles.data(), handles.size(), all_have_handles ? 100 : 2);
    for (Running& child : running_) {
      const double most = jobs_[child.index].limits.wall_seconds;
      if (most <= 0 || seconds_since(child.start) < most) continue;
      child.timed_out = true;
      ::kill(child.process, SIGKILL);
    }
  }

  static int reap(const Running& child, int options = 0) {
    int status = 0;
    const pid_t gone = ::waitpid(child.process, &status, options);
    if (gone != child.process) return -1;
    if (child.handle >= 0) ::close(child.handle);
    return status;
  }

  void collect() {
    for (std::size_t i = 0; i < running_.size();) {
      const Running child = running_[i];
      const int status = reap(child, WNOHANG);
      if (status < 0) {
        ++i;
        continue;
      }
      running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
      if (stopped()) continue;  // it may have ended for that reason
      JobEnd end;
      end.seconds = seconds_since(child.start);
      end.how = child.timed_out       ? JobEnd::How::timed_out
                : WIFSIGNALED(status) ? JobEnd::How::signalled
                                      : JobEnd::How::exited;
      end.code = WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
      ended_(child.index, end);
    }
  }

  [[noreturn]] void end_all() {
    for (const Running& child : running_) ::kill(child.process, SIGTERM);
    const Clock::time_point start = Clock::now();
    while (!running_.empty() && seconds_since(start) < 1.8) {
      collect();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    throw Interrupted();  // the destructor ends those that are left
  }

  std::span<const Job> jobs_;
  const PoolOptions& options_;
  const std::function<void(std::size_t, const JobEnd&)>& ended_;
  std::vector<std::size_t> waiting_;
  std::vector<Running> running_;
};

}  // namespace

void run_jobs(std::span<const Job> jobs, const PoolOptions& options,
              const std::function<void(std::size_t, const JobEnd&)>& ended) {
  Pool(jobs, options, ended).run();
}

double available_memory_mb() {
  std::ifstream info("/proc/meminfo");
  for (std::string word; info >> word;) {
    if (word == "MemAvailable:") {
      double kibibytes = 0;
      info >> kibibytes;
      return kibibytes * 1024 / 1e6;
    }
    info.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return 0;
}

}  // namespace drape::pipeline
