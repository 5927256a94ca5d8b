#include "drape/pipeline/slurm.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"

namespace drape::pipeline {
namespace {

constexpr int most_tasks = 1000;

std::string quoted(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

// "0-3,7": task numbers that count from `first`.
std::string array_text(const std::vector<int>& chunks, int first) {
  std::string text;
  for (std::size_t i = 0; i < chunks.size();) {
    std::size_t last = i;
    while (last + 1 < chunks.size() && chunks[last + 1] == chunks[last] + 1) ++last;
    text += text.empty() ? "" : ",";
    text += last == i ? fmt::format("{}", chunks[i] - first)
                      : fmt::format("{}-{}", chunks[i] - first, chunks[last] - first);
    i = last + 1;
  }
  return text;
}

SlurmJob array_of(const BatchPlan& plan, const MemoryClass& one, const std::vector<int>& chunks,
                  const SlurmOptions& options) {
  const int first = chunks.front();
  const double minutes =
      options.minutes > 0 ? options.minutes : std::max(60.0, 10 * one.longest_chunk_seconds / 60);
  std::string array = array_text(chunks, first);
  if (options.tasks_at_once > 0) array += fmt::format("%{}", options.tasks_at_once);
  const std::string logs = (plan.batch.folder() / "logs").string();
  SlurmJob job;
  job.arguments = {
      "--parsable", "--job-name=drape-" + plan.batch.name, "--array=" + array,
      fmt::format("--mem={}M", static_cast<long>(std::ceil(one.memory_mb * 1e6 / (1024 * 1024)))),
      fmt::format("--cpus-per-task={}", options.threads),
      fmt::format("--time={}", static_cast<long>(std::ceil(minutes))), "--requeue",
      // The worker itself gets SIGTERM a minute before its time is over, and asks to be sent again.
      "--signal=B:TERM@60", "--open-mode=append", "--output=" + logs + "/slurm-%A_%a.log"};
  job.arguments.insert(job.arguments.end(), options.sbatch_args.begin(), options.sbatch_args.end());
  job.script =
      fmt::format("#!/bin/sh\nexec {} --threads {} batch worker {} --chunk $(({} + SLURM_ARRAY_TASK_ID))\n",
                  quoted(options.program), options.threads, quoted(plan.batch.folder().string()), first);
  return job;
}

}  // namespace

std::vector<SlurmJob> slurm_arrays(const BatchPlan& plan, const std::set<int>& wanted,
                                   const SlurmOptions& options) {
  std::vector<SlurmJob> jobs;
  for (const MemoryClass& one : plan.classes) {
    std::vector<int> chunks;
    const auto send = [&] {
      if (!chunks.empty()) jobs.push_back(array_of(plan, one, chunks, options));
      chunks.clear();
    };
    for (int chunk = one.first_chunk; chunk < one.first_chunk + one.chunks; ++chunk) {
      if (wanted.count(chunk) == 0) continue;
      if (!chunks.empty() && chunk - chunks.front() >= most_tasks) send();
      chunks.push_back(chunk);
    }
    send();
  }
  return jobs;
}

std::string submit(const SlurmJob& job) {
  std::array<int, 2> in{};
  std::array<int, 2> out{};
  if (::pipe(in.data()) != 0 || ::pipe(out.data()) != 0)
    throw Error(ErrorCode::try_again, "no pipe can be made to start sbatch");
  const pid_t child = ::fork();
  if (child == 0) {
    std::vector<char*> argv = {const_cast<char*>("sbatch")};
    for (const std::string& argument : job.arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    ::dup2(in[0], STDIN_FILENO);
    ::dup2(out[1], STDOUT_FILENO);
    ::dup2(out[1], STDERR_FILENO);
    for (const int handle : {in[0], in[1], out[0], out[1]}) ::close(handle);
    ::execvp("sbatch", argv.data());
    ::_exit(127);
  }
  ::close(in[0]);
  ::close(out[1]);
  const bool sent =
      ::write(in[1], job.script.data(), job.script.size()) == static_cast<ssize_t>(job.script.size());
  ::close(in[1]);
  std::string said;
  std::array<char, 4096> buffer{};
  for (ssize_t count = 0; (count = ::read(out[0], buffer.data(), buffer.size())) > 0;)
    said.append(buffer.data(), static_cast<std::size_t>(count));
  ::close(out[0]);
  int status = 0;
  if (child > 0) ::waitpid(child, &status, 0);
  while (!said.empty() && said.back() == '\n') said.pop_back();
  if (child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 127)
    throw config_error("sbatch was not found: is Slurm installed on this machine?");
  if (child < 0 || !sent || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw Error(ErrorCode::try_again, "sbatch refused the job: " + said);
  // "--parsable" prints "<job>[;<cluster>]", perhaps after warnings.
  const std::string line = said.substr(said.rfind('\n') == std::string::npos ? 0 : said.rfind('\n') + 1);
  return line.substr(0, line.find(';'));
}

}  // namespace drape::pipeline
