#include <fmt/core.h>

#include "drape/base/error.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/ingest/clean_scan.hpp"
#include "drape/io/records.hpp"
#include "drape/io/scan_files.hpp"
#include "drape/stages/units.hpp"
#include "rows.hpp"

namespace drape::stages {
namespace {

std::vector<RangeScan> read_all(const std::vector<std::filesystem::path>& files, const Progress& progress) {
  std::vector<RangeScan> scans;
  for (std::size_t i = 0; i < files.size(); ++i) {
    progress.update(static_cast<double>(i) / static_cast<double>(files.size()), files[i].filename().string());
    for (RangeScan& scan : io::read_scans(files[i])) scans.push_back(std::move(scan));
  }
  return scans;
}

BoundingBox box_of(const std::vector<RangeScan>& scans) {
  BoundingBox box;
  for (const RangeScan& scan : scans) box.extend(bounding_box(scan.cloud.positions));
  return box;
}

void move_to(const io::WorkspaceFrame& frame, RangeScan& scan) {
  for (Eigen::Vector3d& point : scan.cloud.positions) point = frame.from_input(point);
  if (scan.view.kind == ScanView::Kind::origin) scan.view.vector = frame.from_input(scan.view.vector);
  if (scan.world_from_scan) {
    // x_world = R x_scan + t, with both sides scaled and shifted by the same offset.
    Rigid3& pose = *scan.world_from_scan;
    pose.translation() = pose.translation() * frame.metres_per_input_unit +
                         pose.linear() * frame.world_offset_m - frame.world_offset_m;
  }
  scan.spacing *= frame.metres_per_input_unit;
}

void run(const ingest::CleanOptions& options, pipeline::StageRun& run) {
  std::vector<RangeScan> scans = read_all(run.input().scans, run.progress().part(0, 0.4));
  io::ScansRecord record;
  record.frame = workspace_frame(box_of(scans), run);
  std::size_t points = 0;
  std::size_t dropped = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    run.progress().update(0.4 + 0.6 * static_cast<double>(i) / static_cast<double>(scans.size()),
                          scans[i].file);
    move_to(record.frame, scans[i]);
    const ingest::CleanedScan cleaned = ingest::clean_scan(scans[i], options, {});
    const RangeScan& scan = cleaned.scan;
    if (scan.cloud.empty())
      throw input_error("{}: scan {} has no points left after cleaning; loosen the ingest options", scan.file,
                        scan.index_in_file);
    io::write_scan_ply(run.output("scans/" + three_digits(i) + ".ply"), scan);
    io::ScanRecord& entry = record.scans.emplace_back();
    entry.file = scan.file;
    entry.index_in_file = scan.index_in_file;
    entry.points = scan.cloud.size();
    if (scan.grid) entry.grid = {scan.grid->rows, scan.grid->columns};
    entry.view = scan.view;
    entry.spacing_m = scan.spacing;
    entry.dropped = cleaned.dropped;
    points += scan.cloud.size();
    for (const auto& [filter, count] : cleaned.dropped) dropped += count;
    scans[i] = RangeScan{};  // one scan at a time in memory from here on
  }
  io::write_scans(run.output("scans.json"), record);
  run.metric("scans", static_cast<double>(record.scans.size()));
  run.metric("points", static_cast<double>(points));
  run.metric("dropped_points", static_cast<double>(dropped));
}

}  // namespace

pipeline::Stage ingest_stage() {
  pipeline::Stage stage;
  stage.name = "ingest";
  stage.summary = "Reads the scans, drops bad points, and finds oriented normals.";
  stage.input_parts = {"scans", "units"};
  stage.writes = {"scans.json", "scans/*.ply"};
  stage.applies = [](const pipeline::Input& input) { return !input.scans.empty(); };
  stage.instantiate = pipeline::stage_body(run);
  return stage;
}

}  // namespace drape::stages
