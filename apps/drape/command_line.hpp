// What drape's command line takes, and which command it asks for.
#pragma once

#include <CLI/CLI.hpp>
#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "batch_command.hpp"
#include "commands.hpp"

namespace drape::app {

/// Every subcommand puts what it will do into `action`, which returns the exit code; it runs after the whole
/// command line was understood. `stop_requested` ends what runs.
struct CommandLine {
  explicit CommandLine(const std::atomic<bool>& stop_requested);

  CLI::App app{"drape: raw laser range scans and uncalibrated photos to a textured 3D model, unattended"};
  std::function<int()> action;
  int threads = 0;
  bool quiet = false;
  bool verbose = false;
  ProgressMode progress = ProgressMode::automatic;

  RunArguments run;
  ExplainArguments explain;
  ValidateArguments validate;
  std::filesystem::path status = ".";
  NewArguments create;
  std::filesystem::path reference = "config/REFERENCE.md";
  std::string shell;
  bool reference_check = false;
  SimulateArguments simulate;
  SegmentArguments segment;
  AlignArguments align;
  RelightArguments relight;
  GcArguments gc;
  DiffArguments diff;
  ReportArguments report;
  AdoptArguments adopt;
  MakeArguments make;
  InfoArguments info;
  ConvertArguments convert;
  BatchArguments batch;

 private:
  CLI::App* command(const std::string& name, const std::string& what, const std::string& example);
  void add_sets(CLI::App* sub, std::vector<std::string>& sets);
  void add_progress(CLI::App* sub);
  void add_run();
  void add_status();
  void add_explain();
  void add_validate();
  void add_new();
  void add_make();
  void add_gc();
  void add_report();
  void add_diff();
  void add_adopt();
  void add_info();
  void add_convert();
  void add_reference();
  void add_completion();
  void add_manual();
  void add_segment();
  void add_align();
  void add_relight();
  void add_simulate();

  const std::atomic<bool>& stop_;
};

}  // namespace drape::app
