#include <fmt/format.h>

#include "batch_command.hpp"
#include "commands.hpp"
#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/pipeline/sweep.hpp"
#include "drape/stages/comparison_report.hpp"
#include "drape/stages/stage_table.hpp"

namespace drape::app {
namespace fs = std::filesystem;

int sweep_command(const BatchArguments& arguments, const std::atomic<bool>& stop) {
  const auto table = stages::stage_table();
  pipeline::Sweep sweep = pipeline::read_sweep(arguments.manifest, arguments.sets);
  if (arguments.workspace) sweep.batch.workspace = fs::absolute(*arguments.workspace).lexically_normal();
  // A typo in one value is found now, not in the middle of the night.
  for (const pipeline::BatchObject& object : sweep.batch.objects)
    static_cast<void>(pipeline::object_config(sweep.batch, object, table));
  pipeline::plan_batch(sweep.batch, table, false);
  if (arguments.dry_run) {
    for (std::size_t i = 0; i < sweep.values.size(); ++i) {
      fmt::print("{}", sweep.batch.objects[i].id);
      for (std::size_t j = 0; j < sweep.names.size(); ++j)
        fmt::print("  {}={}", sweep.names[j], sweep.values[i][j]);
      fmt::print("\n");
    }
    return 0;
  }
  pipeline::BatchRunOptions options = run_options(arguments, stop);
  std::size_t done = 0;
  if (!arguments.quiet)
    options.ended = [&](const pipeline::ObjectResult& result) {
      fmt::print(stderr, "[{}/{}] {} {:<7} {:8.2f} s  ran {}\n", ++done, sweep.batch.objects.size(),
                 result.id, result.status, result.seconds,
                 result.ran.empty() ? "nothing" : fmt::format("{}", fmt::join(result.ran, " ")));
    };
  std::vector<const pipeline::BatchObject*> points;
  for (const pipeline::BatchObject& object : sweep.batch.objects) points.push_back(&object);
  pipeline::run_objects(sweep.batch, points, table, options);
  const pipeline::SweepTable results = pipeline::sweep_table(sweep);
  pipeline::write_sweep_table(sweep, results);
  const pipeline::BatchSummary summary = pipeline::summarize(sweep.batch);
  pipeline::write_summary(sweep.batch, summary);
  const fs::path page = stages::write_sweep_report(sweep, results);
  for (const pipeline::ObjectResult& result : summary.results)
    if (result.status == "failed") fmt::print("{} failed: {}\n", result.id, result.message);
  fmt::print("table    {}\nreport   {}\nok {}  review {}  failed {}  missing {}  of {}\n",
             (sweep.batch.folder() / "table.csv").string(), page.string(), summary.ok, summary.review,
             summary.failed, summary.missing, summary.objects);
  return summary.complete() ? 0 : 1;
}

}  // namespace drape::app
