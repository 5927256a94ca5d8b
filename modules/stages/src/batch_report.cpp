#include "drape/stages/batch_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/io/photo.hpp"
#include "drape/pipeline/workspace.hpp"
#include "drape/report/batch_page.hpp"
#include "drape/report/contact_sheet.hpp"

namespace drape::stages {
namespace fs = std::filesystem;
namespace {

constexpr int thumbnail_side_px = 200;
constexpr std::size_t most_thumbnails = 100;  // they are looked at one by one

// The first overlay that the run has; empty if there is none.
std::string overlay_of(const pipeline::Workspace& workspace, const std::string& run) {
  const auto record = pipeline::read_run_record(workspace.run_folder(run) / "run.json");
  if (!record) return {};
  for (const pipeline::RunStage& stage : record->stages) {
    if (stage.stage != "align") continue;
    const fs::path file = workspace.stage_folder(stage.stage, stage.key) / "000" / "overlay.png";
    if (!fs::exists(file)) return {};
    try {
      return io::encode_image(report::fitted(io::read_photo(file).rgb, thumbnail_side_px, thumbnail_side_px),
                              "jpg", 82);
    } catch (const Error&) {
      return {};  // a damaged picture is not worth the page; the next run finds and mends it
    }
  }
  return {};
}

report::BatchRow row_of(const pipeline::Batch& batch, const pipeline::ObjectResult& result) {
  report::BatchRow row;
  row.object = result.id;
  row.status = result.status;
  row.message = result.message;
  if (result.status == "failed") row.stage = result.stage;
  row.ran = fmt::format("{}", fmt::join(result.ran, " "));
  row.seconds = result.seconds;
  row.peak_memory_mb = result.peak_memory_mb;
  const fs::path page =
      pipeline::Workspace(batch.workspace).run_folder(batch.run_name(result.id)) / "report.html";
  if (fs::exists(page)) row.link = page.lexically_relative(batch.folder()).generic_string();
  return row;
}

}  // namespace

fs::path write_batch_report(const pipeline::Batch& batch, const pipeline::BatchSummary& summary) {
  report::BatchPage page;
  page.title = batch.name;
  page.facts = fmt::format("{} objects of {}: {} ok, {} for review, {} failed, {} missing", summary.objects,
                           batch.source.filename().string(), summary.ok, summary.review, summary.failed,
                           summary.missing);
  page.apply_command = fmt::format("drape batch apply fixes.yaml {}", batch.source.string());
  const pipeline::Workspace workspace(batch.workspace);
  std::size_t thumbnails = 0;
  for (const pipeline::ObjectResult& result : summary.results) {
    page.rows.push_back(row_of(batch, result));
    if (result.status == "review" && ++thumbnails <= most_thumbnails)
      page.rows.back().png_or_jpeg_bytes = overlay_of(workspace, batch.run_name(result.id));
  }
  for (const std::string& id : summary.missing_ids) {
    report::BatchRow row;
    row.object = id;
    row.status = "missing";
    row.message = "no result of its present configuration";
    page.rows.push_back(row);
  }
  const auto rank = [](const report::BatchRow& row) {
    return row.status == "failed" ? 0 : row.status == "missing" ? 1 : row.status == "review" ? 2 : 3;
  };
  std::stable_sort(page.rows.begin(), page.rows.end(),
                   [&](const report::BatchRow& a, const report::BatchRow& b) { return rank(a) < rank(b); });
  const fs::path file = batch.folder() / "report.html";
  write_file(file, report::render_batch(page));
  return file;
}

}  // namespace drape::stages
