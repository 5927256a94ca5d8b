#include "batch_command_line.hpp"

namespace drape::app {
namespace {

CLI::App* command(CLI::App& parent, const std::string& name, const std::string& what,
                  const std::string& example) {
  CLI::App* sub = parent.add_subcommand(name, what);
  sub->footer("Example:\n  " + example);
  return sub;
}

void add_manifest(CLI::App* sub, BatchArguments& arguments, const std::string& what) {
  sub->add_option("manifest", arguments.manifest, what)->required()->type_name("MANIFEST");
  sub->add_option("--workspace", arguments.workspace, "Folder for all results")->type_name("DIR");
  sub->add_option("-o,--output", arguments.output, "Folder for the finished models, one folder each")
      ->type_name("DIR");
}

void add_jobs(CLI::App* sub, BatchArguments& arguments) {
  sub->add_option("-j,--jobs", arguments.jobs,
                  "The most objects at once; the cores are divided among them, unless --threads says how "
                  "many each has")
      ->check(CLI::Range(1, 4096))
      ->type_name("N");
  sub->add_option("--memory-mb", arguments.memory_mb,
                  "Memory of all objects together: one starts only while its estimate fits; 0: nine tenths "
                  "of what is free")
      ->check(CLI::NonNegativeNumber)
      ->type_name("MB");
  sub->add_option("--object-memory-mb", arguments.object_memory_mb,
                  "Address space of one object; 0: no limit")
      ->check(CLI::NonNegativeNumber)
      ->type_name("MB");
  sub->add_option("--object-seconds", arguments.object_seconds, "Time of one object; 0: no limit")
      ->check(CLI::NonNegativeNumber)
      ->type_name("S");
  sub->add_option("--object-cpu-seconds", arguments.object_cpu_seconds,
                  "Processor time of one object; 0: no limit")
      ->check(CLI::NonNegativeNumber)
      ->type_name("S");
}

void add_chunk_size(CLI::App* sub, BatchArguments& arguments) {
  sub->add_option("--chunk-size", arguments.chunk_size, "Objects in one task of a cluster; default: 20")
      ->check(CLI::Range(1, 100000))
      ->type_name("N");
}

void add_submit(CLI::App& batch, BatchArguments& arguments, std::function<int()>& action) {
  CLI::App* sub =
      command(batch, "submit", "Send what is not done yet to a cluster, one job array per memory class",
              "drape batch submit objects.yaml --executor slurm --sbatch-arg=--partition=long");
  add_manifest(sub, arguments, "The manifest, or a plan of it");
  add_chunk_size(sub, arguments);
  sub->add_option("--executor", "slurm")->required()->check(CLI::IsMember({"slurm"}))->type_name("NAME");
  sub->add_option("-j,--jobs", arguments.jobs,
                  "The most tasks of an array at once; 1: as many as there is room for")
      ->check(CLI::Range(1, 100000))
      ->type_name("N");
  sub->add_option("--task-minutes", arguments.task_minutes,
                  "Time of one task; 0: ten times the estimate, an hour at least")
      ->check(CLI::NonNegativeNumber)
      ->type_name("MIN");
  sub->add_option("--sbatch-arg", arguments.sbatch_args, "Handed on to sbatch; may be given again")
      ->type_name("ARG")
      ->allow_extra_args(false);
  sub->add_flag("--dry-run", arguments.dry_run, "Print the sbatch commands, and send nothing");
  sub->callback([&] { action = [&] { return batch_submit_command(arguments); }; });
}

}  // namespace

void add_batch_commands(CLI::App& app, BatchArguments& arguments, std::function<int()>& action,
                        const std::atomic<bool>& stop) {
  CLI::App* batch =
      command(app, "batch", "Run many objects, here or on a cluster", "drape batch run objects.csv --jobs 4");
  batch->require_subcommand(1);
  const std::string manifest = "YAML, CSV, or a folder with a folder per object";

  CLI::App* run = command(*batch, "run", "Run all objects of a manifest, each in a process of its own",
                          "drape batch run objects.csv --jobs 4");
  add_manifest(run, arguments, manifest);
  add_jobs(run, arguments);
  run->add_flag("--retry-failed", arguments.retry_failed, "Only the objects that failed or have no result");
  run->callback([&] { action = [&] { return batch_run_command(arguments, stop); }; });

  CLI::App* plan =
      command(*batch, "plan", "Freeze a manifest with its files' digests and estimates, in chunks",
              "drape batch plan objects.csv");
  add_manifest(plan, arguments, manifest);
  add_chunk_size(plan, arguments);
  plan->callback([&] { action = [&] { return batch_plan_command(arguments); }; });

  add_submit(*batch, arguments, action);

  CLI::App* worker =
      command(*batch, "worker", "Do one chunk of a plan, on any machine that sees the workspace",
              "drape batch worker drape-workspace/batches/objects --chunk 0");
  worker->add_option("plan", arguments.manifest, "The plan")->required()->type_name("PLAN");
  worker->add_option("--chunk", arguments.chunk, "Number of the chunk, from 0")
      ->required()
      ->check(CLI::NonNegativeNumber)
      ->type_name("N");
  add_jobs(worker, arguments);
  worker->callback([&] { action = [&] { return batch_worker_command(arguments, stop); }; });

  CLI::App* status =
      command(*batch, "status", "Tell from the result records what is done, failed and missing",
              "drape batch status objects.csv");
  add_manifest(status, arguments, "The manifest, or a plan of it");
  status->callback([&] { action = [&] { return batch_status_command(arguments); }; });

  CLI::App* apply = command(*batch, "apply", "Keep corrections for some objects, and run these again",
                            "drape batch apply fixes.yaml objects.csv");
  apply->add_option("fixes", arguments.fixes, "The corrections")->required()->type_name("FIXES");
  add_manifest(apply, arguments, manifest);
  add_jobs(apply, arguments);
  apply->callback([&] { action = [&] { return batch_apply_command(arguments, stop); }; });

  CLI::App* sweep =
      command(app, "sweep", "Run an experiment: the sweep: section of a configuration, into one table",
              "drape sweep config/thesis_tables.yaml --jobs 2");
  sweep->add_option("config", arguments.manifest, "The configuration")->required()->type_name("CONFIG");
  sweep->add_option("--set", arguments.sets, "Takes the place of a value in the file; may be given again")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  sweep->add_option("--workspace", arguments.workspace, "Folder for all results")->type_name("DIR");
  add_jobs(sweep, arguments);
  sweep->add_flag("--dry-run", arguments.dry_run, "List the points, and run nothing");
  sweep->callback([&] { action = [&] { return sweep_command(arguments, stop); }; });
}

}  // namespace drape::app
