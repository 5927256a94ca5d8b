#include "drape/pipeline/batch.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstring>
#include <new>
#include <thread>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/hash.hpp"
#include "drape/base/log.hpp"
#include "drape/base/parallel.hpp"
#include "drape/pipeline/workspace.hpp"

namespace drape::pipeline {
namespace fs = std::filesystem;
namespace {

// Exit codes between an object's process and the one that started it.
constexpr int recorded = 0;
constexpr int may_pass = 75;

constexpr int attempts_in_process = 3;

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

std::string class_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::config:
      return "config";
    case ErrorCode::input:
      return "input";
    case ErrorCode::bug:
      return "bug";
    case ErrorCode::io:
      return "io";
    case ErrorCode::try_again:
      return "try_again";
  }
  return "bug";
}

// Remembers which stage was at work, for the record of a failure.
class LastStage : public RunObserver {
 public:
  void stage_started(const Stage& stage, std::size_t, std::size_t, const std::string& why) override {
    name = stage.name;
    log::info("{}: {}", stage.name, why);
  }
  void stage_progress(const Stage&, double, std::string_view) override {}
  void stage_finished(const Stage&, std::size_t, std::size_t, const StageRecord&, bool) override {}

  std::string name;
};

void fail(ObjectResult& result, const std::string& error, const std::string& message) {
  result.status = "failed";
  result.error = error;
  result.message = message;
}

void run_one(const Batch& batch, const BatchObject& object, std::span<const Stage> table,
             const BatchRunOptions& options, LastStage& observer, ObjectResult& result) {
  const Config config = object_config(batch, object, table);
  for (const auto& [file, digest] : object.inputs)
    if (sha256_file(file) != digest) throw input_error("{}: was changed since the batch was planned", file);
  RunOptions run_options;
  run_options.name = batch.run_name(object.id);
  run_options.publish = !batch.output.empty();
  run_options.command = options.command;
  run_options.versions = options.versions;
  run_options.stop = options.pool.stop;
  const RunResult run_result = run(config, run_options, observer);
  if (options.after_run) options.after_run(config, run_result);
  result.status = run_result.record.status;
  for (const std::string& reason : run_result.record.reasons)
    result.message += (result.message.empty() ? "" : "; ") + reason;
  for (const StageRecord& stage : run_result.stages) {
    result.peak_memory_mb = std::max(result.peak_memory_mb, stage.peak_memory_mb);
    if (run_result.published.empty() || &stage != &run_result.stages.back()) continue;
    for (const StageFile& file : stage.files) result.files.emplace_back(file.name, file.digest);
  }
  for (const RunStage& stage : run_result.record.stages) {
    if (stage.ran) result.ran.push_back(stage.stage);
    result.stage_seconds += stage.seconds;
  }
}

// One attempt; every failure ends up in the result. Returns whether another attempt may go better.
bool attempt(const Batch& batch, const BatchObject& object, std::span<const Stage> table,
             const BatchRunOptions& options, ObjectResult& result) {
  LastStage observer;
  try {
    run_one(batch, object, table, options, observer, result);
    return false;
  } catch (const Error& error) {
    fail(result, class_of(error.code()), error.what());
  } catch (const std::bad_alloc&) {
    fail(result, "memory", "it wanted more memory than there is, or than it may have");
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception& error) {
    fail(result, "bug", error.what());
  }
  result.stage = observer.name;
  log::warn("{}", result.message);
  return result.error == "try_again";
}

// The work of an object's process.
int object_process(const Batch& batch, const BatchObject& object, std::span<const Stage> table,
                   const BatchRunOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  set_thread_count(options.threads);
  try {
    ObjectResult result;
    for (int i = 1;; ++i) {
      result = {};
      result.id = object.id;
      result.config_digest = object.digest;
      if (!attempt(batch, object, table, options, result)) break;
      if (i == attempts_in_process) {
        if (!options.last_attempt) return may_pass;
        break;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(300 * i));
    }
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    struct rusage usage {};
    ::getrusage(RUSAGE_SELF, &usage);
    result.peak_memory_mb =
        std::max(result.peak_memory_mb, static_cast<double>(usage.ru_maxrss) * 1024 / 1e6);
    result.host = host_name();
    result.finished_at = utc_now();
    write_object_result(batch.result_file(object.id), result);
    return recorded;
  } catch (const Interrupted&) {
    return may_pass;
  }
}

// For a process that left no record.
ObjectResult result_of_death(const BatchObject& object, const JobEnd& end, const JobLimits& limits,
                             const fs::path& log) {
  ObjectResult result;
  result.id = object.id;
  result.config_digest = object.digest;
  result.seconds = end.seconds;
  result.host = host_name();
  result.finished_at = utc_now();
  const std::string see = "; see " + log.string();
  if (end.how == JobEnd::How::timed_out)
    fail(result, "timeout", fmt::format("it took more than its {:.0f} s", limits.wall_seconds) + see);
  else if (end.how == JobEnd::How::signalled && end.code == SIGXCPU)
    fail(result, "timeout",
         fmt::format("it took more than its {:.0f} s of processor time", limits.cpu_seconds) + see);
  else if (end.how == JobEnd::How::signalled && end.code == SIGKILL)
    fail(result, "memory", "it was killed from outside, as the system does when memory runs out" + see);
  else if (end.how == JobEnd::How::signalled)
    fail(result, "crash", fmt::format("it crashed: {}", ::strsignal(end.code)) + see);
  else
    fail(result, "io", fmt::format("it ended with {} and could not record a result", end.code) + see);
  return result;
}

double megabytes(const fs::path& file) {
  std::error_code problem;
  const auto bytes = fs::file_size(file, problem);
  return problem ? 0 : static_cast<double>(bytes) / 1e6;
}

std::vector<fs::path> files_of(const Input& input) {
  std::vector<fs::path> files;
  for (const ScanInput& scan : input.scans) files.push_back(scan.file);
  for (const fs::path& file : {input.poses, input.mesh, input.cameras})
    if (!file.empty()) files.push_back(file);
  for (const PhotoInput& photo : input.photos) {
    files.push_back(photo.image);
    if (!photo.mask.empty()) files.push_back(photo.mask);
  }
  return files;
}

// Rough, for an object that never ran: what matters is that no memory is promised twice. A compressed photo
// unfolds to many times its size, and scans to their tree and normals.
void estimate_by_size(BatchObject& object, const Input& input) {
  double surface_mb = megabytes(input.mesh);
  for (const ScanInput& scan : input.scans) surface_mb += megabytes(scan.file);
  double photos_mb = 0;
  for (const PhotoInput& photo : input.photos) photos_mb += megabytes(photo.image);
  object.memory_mb = 150 + 20 * surface_mb + 60 * photos_mb;
  object.seconds = 0.1 + 2 * surface_mb + 5 * photos_mb;
}

}  // namespace

Config object_config(const Batch& batch, const BatchObject& object, std::span<const Stage> table) {
  if (!object.unreadable.empty()) throw config_error("{}", object.unreadable);
  Config config = configure({object.id, batch.source, flow_text(object.root), object.root}, table, {});
  config.workspace = batch.workspace;
  config.output = batch.output / object.id;
  return config;
}

void plan_batch(Batch& batch, std::span<const Stage> table, bool digests) {
  FileDigests known(batch.folder() / "digests.json");
  for (BatchObject& object : batch.objects) {
    object.digest = sha256(flow_text(object.root) + object.unreadable);
    try {
      const Config config = object_config(batch, object, table);
      estimate_by_size(object, config.input);
      if (digests)
        for (const fs::path& file : files_of(config.input))
          object.inputs.emplace_back(file.string(), known.of(file));
    } catch (const Error& error) {
      object.problem = error.what();
    }
    if (const auto before = read_object_result(batch.result_file(object.id));
        before && before->error.empty()) {
      object.memory_mb = std::max(before->peak_memory_mb * 1.2, 50.0);
      // A result that was all reused says nothing of the work.
      if (!before->ran.empty()) object.seconds = before->seconds;
    }
  }
  make_folder(batch.folder());
  if (digests) known.save();
}

std::size_t run_objects(const Batch& batch, std::span<const BatchObject* const> objects,
                        std::span<const Stage> table, const BatchRunOptions& options) {
  const fs::path logs = batch.folder() / "logs";
  make_folder(logs);
  make_folder(batch.folder() / "results");
  std::vector<Job> jobs;
  for (const BatchObject* object : objects) {
    Job job;
    job.work = [&batch, object, table, &options] { return object_process(batch, *object, table, options); };
    job.estimated_memory_mb = object->memory_mb;
    job.limits = options.limits;
    job.log = logs / (object->id + ".log");
    jobs.push_back(std::move(job));
  }
  std::size_t left = 0;
  run_jobs(jobs, options.pool, [&](std::size_t index, const JobEnd& end) {
    const BatchObject& object = *objects[index];
    if (end.how == JobEnd::How::exited && end.code == may_pass) {
      ++left;
      return;
    }
    const fs::path file = batch.result_file(object.id);
    if (end.how != JobEnd::How::exited || end.code != recorded)
      write_object_result(file, result_of_death(object, end, options.limits, jobs[index].log));
    if (const auto result = read_object_result(file); result && options.ended) options.ended(*result);
  });
  return left;
}

std::vector<const BatchObject*> longest_first(const Batch& batch) {
  std::vector<const BatchObject*> objects;
  for (const BatchObject& object : batch.objects) objects.push_back(&object);
  std::stable_sort(objects.begin(), objects.end(),
                   [](const BatchObject* a, const BatchObject* b) { return a->seconds > b->seconds; });
  return objects;
}

}  // namespace drape::pipeline
