#include "program.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <sstream>
#include <thread>

#include "drape/base/files.hpp"
#include "support.hpp"

namespace drape::test {
namespace {

pid_t start(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
            const std::filesystem::path& out, const std::filesystem::path& err) {
  std::vector<char*> argv = {const_cast<char*>("drape")};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    if (::chdir(folder.c_str()) != 0 || std::freopen(out.c_str(), "w", stdout) == nullptr ||
        std::freopen(err.c_str(), "w", stderr) == nullptr)
      ::_exit(127);
    ::execv(DRAPE_PROGRAM, argv.data());
    ::_exit(127);
  }
  return child;
}

Outcome finish(pid_t child, const std::filesystem::path& out, const std::filesystem::path& err) {
  int status = 0;
  ::waitpid(child, &status, 0);
  Outcome outcome;
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.out = read_file(out);
  outcome.err = read_file(err);
  return outcome;
}

}  // namespace

Outcome run_drape(const std::vector<std::string>& arguments, const std::filesystem::path& folder) {
  const ScratchFolder scratch;
  return finish(start(arguments, folder, scratch / "out", scratch / "err"), scratch / "out", scratch / "err");
}

Outcome run_drape_and_signal(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                             int signal, const std::filesystem::path& begun) {
  const ScratchFolder scratch;
  const pid_t child = start(arguments, folder, scratch / "out", scratch / "err");
  constexpr int most_waits = 6000;
  for (int i = 0; i < most_waits && !std::filesystem::exists(begun); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ::kill(child, signal);
  return finish(child, scratch / "out", scratch / "err");
}

std::vector<std::string> stages_that_ran(const Outcome& outcome) {
  std::vector<std::string> stages;
  std::istringstream lines(outcome.err);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t name = line.find("] ");
    const std::size_t end = line.find(": ", name == std::string::npos ? 0 : name);
    if (line.empty() || line[0] != '[' || name == std::string::npos || end == std::string::npos) continue;
    const std::string stage = line.substr(name + 2, end - name - 2);
    if (stage.find(' ') == std::string::npos && (stages.empty() || stages.back() != stage))
      stages.push_back(stage);
  }
  return stages;
}

}  // namespace drape::test
