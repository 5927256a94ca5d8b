#include "batch_command.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <thread>

#include "commands.hpp"
#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/numbers.hpp"
#include "drape/pipeline/batch_plan.hpp"
#include "drape/pipeline/fixes.hpp"
#include "drape/pipeline/manifest.hpp"
#include "drape/pipeline/slurm.hpp"
#include "drape/stages/batch_report.hpp"
#include "drape/stages/run_report.hpp"
#include "drape/stages/stage_table.hpp"

namespace drape::app {
namespace fs = std::filesystem;
namespace {

using pipeline::Batch;
using pipeline::BatchObject;
using pipeline::BatchPlan;
using pipeline::BatchSummary;
using pipeline::ObjectResult;

constexpr int partly_failed = 1;
constexpr int try_again = 75;
constexpr int most_restarts = 3;  // of a task; then what may pass is recorded as a failure

fs::path fixes_file(const Batch& batch) {
  return batch.folder() / "fixes.yaml";
}

void apply_stored_fixes(Batch& batch) {
  if (!fs::exists(fixes_file(batch))) return;
  for (const pipeline::ObjectFixes& fixes : pipeline::read_fixes(fixes_file(batch)))
    for (BatchObject& object : batch.objects)
      if (object.id == fixes.object) {
        try {
          pipeline::apply_fixes(object.root, fixes);
        } catch (const Error& error) {
          object.unreadable = error.what();
        }
      }
}

// The manifest as it is now, with the fixes that were applied to it before.
Batch batch_of(const BatchArguments& arguments) {
  Batch batch = pipeline::read_manifest(arguments.manifest);
  if (arguments.workspace) batch.workspace = fs::absolute(*arguments.workspace).lexically_normal();
  if (arguments.output) batch.output = fs::absolute(*arguments.output).lexically_normal();
  apply_stored_fixes(batch);
  return batch;
}

// A plan, or a manifest, which is planned now.
BatchPlan plan_of(const BatchArguments& arguments, bool digests) {
  if (pipeline::is_plan(arguments.manifest)) return pipeline::read_plan(arguments.manifest);
  Batch batch = batch_of(arguments);
  pipeline::plan_batch(batch, stages::stage_table(), digests);
  return pipeline::write_plan(std::move(batch), arguments.chunk_size);
}

int threads_each(const BatchArguments& arguments) {
  if (arguments.threads > 0) return arguments.threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / arguments.jobs);
}

// A page for each of thousands of objects takes longer than small objects themselves: where nothing was
// wrong, `drape report` makes it when it is wanted. One that is there must not tell what is no longer so.
void report_reviews(const pipeline::Config& config, const pipeline::RunResult& result) {
  if (result.record.status == "review" || fs::exists(result.folder / "report.html"))
    stages::write_run_report(config, result, versions());
}

void print_result(const ObjectResult& result, std::size_t done, std::size_t count) {
  fmt::print(stderr, "[{}/{}] {:<20} {:<7} {:8.2f} s  {}\n", done, count, result.id, result.status,
             result.seconds, result.message.substr(0, result.message.find('\n')));
}

int print_summary(const Batch& batch, const BatchSummary& summary, std::size_t most_lines = 20) {
  std::size_t lines = 0;
  for (const ObjectResult& result : summary.results) {
    if (result.status == "ok" || ++lines > most_lines) break;
    fmt::print("{:<20} {:<7} {}{}{}\n", result.id, result.status, result.error,
               result.error.empty() ? "" : ": ", result.message.substr(0, result.message.find('\n')));
  }
  if (summary.failed + summary.review > most_lines)
    fmt::print("... and {} more in {}\n", summary.failed + summary.review - most_lines,
               (batch.folder() / "summary.json").string());
  fmt::print("report   {}\n", stages::write_batch_report(batch, summary).string());
  fmt::print("ok {}  review {}  failed {}  missing {}  of {}\n", summary.ok, summary.review, summary.failed,
             summary.missing, summary.objects);
  return summary.complete() ? 0 : partly_failed;
}

// Runs the chosen objects, and tells what became of the whole batch.
int run_and_tell(const Batch& batch, const std::vector<const BatchObject*>& objects,
                 const BatchArguments& arguments, const std::atomic<bool>& stop) {
  pipeline::BatchRunOptions options = run_options(arguments, stop);
  options.after_run = report_reviews;
  std::size_t done = 0;
  if (!arguments.quiet)
    options.ended = [&](const ObjectResult& result) { print_result(result, ++done, objects.size()); };
  pipeline::run_objects(batch, objects, stages::stage_table(), options);
  const BatchSummary summary = pipeline::summarize(batch);
  pipeline::write_summary(batch, summary);
  return print_summary(batch, summary);
}

// Objects without a result of their present configuration that is ok or for review.
std::vector<const BatchObject*> not_done(const Batch& batch) {
  std::vector<const BatchObject*> objects;
  for (const BatchObject* object : pipeline::longest_first(batch)) {
    const auto result = pipeline::read_object_result(batch.result_file(object->id));
    if (!result || result->config_digest != object->digest || result->status == "failed")
      objects.push_back(object);
  }
  return objects;
}

}  // namespace

pipeline::BatchRunOptions run_options(const BatchArguments& arguments, const std::atomic<bool>& stop) {
  pipeline::BatchRunOptions options;
  options.pool.at_once = arguments.jobs;
  options.pool.memory_mb =
      arguments.memory_mb > 0 ? arguments.memory_mb : 0.9 * pipeline::available_memory_mb();
  options.pool.stop = &stop;
  options.limits = {arguments.object_seconds, arguments.object_cpu_seconds, arguments.object_memory_mb};
  options.threads = threads_each(arguments);
  options.command = arguments.command;
  options.versions = versions();
  return options;
}

int batch_run_command(const BatchArguments& arguments, const std::atomic<bool>& stop) {
  const BatchPlan plan = plan_of(arguments, false);
  return run_and_tell(plan.batch,
                      arguments.retry_failed ? not_done(plan.batch) : pipeline::longest_first(plan.batch),
                      arguments, stop);
}

int batch_plan_command(const BatchArguments& arguments) {
  const BatchPlan plan = plan_of(arguments, true);
  double seconds = 0;
  std::size_t problems = 0;
  for (const BatchObject& object : plan.batch.objects) {
    seconds += object.seconds;
    if (object.problem.empty()) continue;
    ++problems;
    fmt::print(stderr, "{}: {}\n", object.id, object.problem);
  }
  for (const pipeline::MemoryClass& one : plan.classes)
    fmt::print("under {:.0f} MB: {} chunks, the longest about {:.0f} s\n", one.memory_mb, one.chunks,
               one.longest_chunk_seconds);
  fmt::print("{} objects, about {:.0f} s of work, {} that cannot run as they are\nplan     {}\n",
             plan.batch.objects.size(), seconds, problems, plan.batch.folder().string());
  return problems == 0 ? 0 : partly_failed;
}

int batch_worker_command(const BatchArguments& arguments, const std::atomic<bool>& stop) {
  const BatchPlan plan = pipeline::read_plan(arguments.manifest);
  std::vector<const BatchObject*> objects;
  for (const BatchObject* object : pipeline::objects_of_chunk(plan, arguments.chunk)) {
    // A task may be sent twice; what is done stays done.
    const auto result = pipeline::read_object_result(plan.batch.result_file(object->id));
    if (!result || result->config_digest != object->digest || result->status == "failed")
      objects.push_back(object);
  }
  const char* restarts = std::getenv("SLURM_RESTART_COUNT");
  pipeline::BatchRunOptions options = run_options(arguments, stop);
  options.after_run = report_reviews;
  options.last_attempt = restarts != nullptr && parse_integer(restarts).value_or(0) >= most_restarts;
  try {
    return pipeline::run_objects(plan.batch, objects, stages::stage_table(), options) == 0 ? 0 : try_again;
  } catch (const Interrupted&) {
    return try_again;  // its time was over, or the node is wanted back: what is not done is done next time
  }
}

int batch_submit_command(const BatchArguments& arguments) {
  const BatchPlan plan = plan_of(arguments, true);
  std::set<int> chunks;
  for (const BatchObject* object : not_done(plan.batch)) chunks.insert(object->chunk);
  if (chunks.empty()) {
    fmt::print("all {} objects are done\n", plan.batch.objects.size());
    return 0;
  }
  make_folder(plan.batch.folder() / "logs");
  pipeline::SlurmOptions options;
  options.program = fs::read_symlink("/proc/self/exe").string();
  options.tasks_at_once = arguments.jobs > 1 ? arguments.jobs : 0;
  options.minutes = arguments.task_minutes;
  options.threads = std::max(1, arguments.threads);
  options.sbatch_args = arguments.sbatch_args;
  for (const pipeline::SlurmJob& job : pipeline::slurm_arrays(plan, chunks, options)) {
    if (arguments.dry_run) {
      fmt::print("sbatch");
      for (const std::string& argument : job.arguments) fmt::print(" '{}'", argument);
      fmt::print(" <<'END'\n{}END\n", job.script);
      continue;
    }
    fmt::print("job      {}\n", pipeline::submit(job));
  }
  fmt::print("plan     {}\n", plan.batch.folder().string());
  return 0;
}

int batch_status_command(const BatchArguments& arguments) {
  Batch batch;
  if (pipeline::is_plan(arguments.manifest)) {
    batch = pipeline::read_plan(arguments.manifest).batch;
  } else {
    const Batch listed = batch_of(arguments);
    batch = pipeline::read_plan(listed.folder()).batch;
  }
  const BatchSummary summary = pipeline::summarize(batch);
  pipeline::write_summary(batch, summary);
  return print_summary(batch, summary, 1000);
}

int batch_apply_command(const BatchArguments& arguments, const std::atomic<bool>& stop) {
  Batch batch = batch_of(arguments);
  const std::vector<pipeline::ObjectFixes> fixes = pipeline::read_fixes(arguments.fixes);
  std::set<std::string> touched;
  for (const pipeline::ObjectFixes& one : fixes) {
    const auto object = std::find_if(batch.objects.begin(), batch.objects.end(),
                                     [&](const BatchObject& o) { return o.id == one.object; });
    if (object == batch.objects.end())
      throw config_error("{}: object {}: is not in {}", one.where.text(), one.object, batch.source.string());
    pipeline::apply_fixes(object->root, one);  // a fix that does not fit is not stored
    touched.insert(one.object);
  }
  make_folder(batch.folder());
  const fs::path stored = fixes_file(batch);
  pipeline::write_fixes(stored, pipeline::joined(fs::exists(stored) ? pipeline::read_fixes(stored)
                                                                    : std::vector<pipeline::ObjectFixes>{},
                                                 fixes));
  pipeline::plan_batch(batch, stages::stage_table(), false);
  const BatchPlan plan = pipeline::write_plan(std::move(batch), arguments.chunk_size);
  std::vector<const BatchObject*> objects;
  for (const BatchObject* object : pipeline::longest_first(plan.batch))
    if (touched.count(object->id) != 0) objects.push_back(object);
  return run_and_tell(plan.batch, objects, arguments, stop);
}

}  // namespace drape::app
