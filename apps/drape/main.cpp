// drape: the command line. Parses, calls one command, and is the only place that catches, prints and exits.
#include <fmt/core.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <csignal>

#include "command_line.hpp"
#include "drape/base/error.hpp"
#include "drape/base/log.hpp"
#include "drape/base/parallel.hpp"

namespace {

using namespace drape;
using namespace drape::app;

std::atomic<bool> stop_requested{false};
std::atomic<int> stop_signal{0};

// Work that does not look at the flag in time is ended all the same: results are written aside, so nothing
// that counts is lost.
void on_alarm(int) {
  static constexpr char text[] = "\ndrape: interrupted; what was finished is kept\n";
  static_cast<void>(!::write(STDERR_FILENO, text, sizeof text - 1));
  ::_exit(128 + (stop_signal == 0 ? SIGINT : stop_signal.load()));
}

void on_signal(int signal) {
  stop_requested = true;
  stop_signal = signal;
  // A second one ends the program at once.
  std::signal(signal, SIG_DFL);
  std::signal(SIGALRM, on_alarm);
  constexpr suseconds_t patience_us = 500'000;
  const struct itimerval patience {
    {0, 0}, { 1, patience_us }
  };
  ::setitimer(ITIMER_REAL, &patience, nullptr);
}

std::string command_line(int argc, char** argv) {
  std::string text = "drape";
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool plain = !word.empty() && word.find_first_not_of(
                                            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                            "0123456789_-+=./:,@%") == std::string::npos;
    if (plain) {
      text += " " + word;
      continue;
    }
    text += " '";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    text += "'";
  }
  return text;
}

int report_error(const Error& error) {
  fmt::print(stderr, "drape: {}\n", error.what());
  if (error.code() == ErrorCode::bug)
    fmt::print(stderr,
               "drape: this is a bug of drape, not of your files; please report it with the run's log\n");
  return exit_code(error.code());
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  CommandLine line(stop_requested);
  line.run.command = command_line(argc, argv);
  line.batch.command = line.run.command;
  try {
    line.app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return line.app.exit(error);  // --help, --version
    fmt::print(stderr, "drape: {}\nTry: drape --help\n", error.what());
    return exit_code(ErrorCode::config);
  }
  try {
    if (line.quiet) log::set_console_level(log::Level::warning);
    if (line.verbose) log::set_console_level(log::Level::debug);
    set_thread_count(line.threads);
    line.batch.quiet = line.quiet;
    line.batch.threads = line.threads;
    return line.action();
  } catch (const Interrupted&) {
    fmt::print(stderr,
               "drape: interrupted; what was finished is kept, and the same command goes on from there\n");
    return 128 + (stop_signal == 0 ? SIGINT : stop_signal.load());
  } catch (const Error& error) {
    return report_error(error);
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "drape: out of memory\n");
    return exit_code(ErrorCode::try_again);
  } catch (const std::exception& error) {
    return report_error(Error(ErrorCode::bug, error.what()));
  }
}
