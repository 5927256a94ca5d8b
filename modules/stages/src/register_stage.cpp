#include <fmt/core.h>

#include <algorithm>
#include <map>

#include "drape/base/error.hpp"
#include "drape/base/log.hpp"
#include "drape/io/records.hpp"
#include "drape/io/scan_files.hpp"
#include "drape/registration/register_scans.hpp"
#include "posed_scans.hpp"
#include "rows.hpp"

namespace drape::stages {
namespace {

// A pose of the input's units and frame, in the workspace's: x_world = R x_scan + t on both sides scaled and
// shifted.
Rigid3 in_workspace(const Rigid3& pose, const io::WorkspaceFrame& frame,
                    const Eigen::Vector3d& scan_offset_m) {
  Rigid3 moved = pose;
  moved.translation() =
      pose.translation() * frame.metres_per_input_unit + pose.linear() * scan_offset_m - frame.world_offset_m;
  return moved;
}

// Poses as the configuration states them for a scan, else by the file of poses where it names the scan, else
// those that the scan files themselves state.
std::vector<std::optional<Rigid3>> given_poses(const std::vector<RangeScan>& scans,
                                               const io::ScansRecord& record, const pipeline::Input& input) {
  const std::filesystem::path& file = input.poses;
  std::map<std::string, Rigid3> named;
  if (!file.empty()) named = io::read_scan_poses(file);
  std::vector<std::optional<Rigid3>> poses;
  const auto stated = [&](const RangeScan& scan) {
    return std::any_of(input.scans.begin(), input.scans.end(), [&](const pipeline::ScanInput& known) {
      return known.world_from_scan && known.file.filename() == scan.file;
    });
  };
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const RangeScan& scan = scans[i];
    const auto found = named.find(scan.file);
    if (found != named.end() && !stated(scan))
      poses.emplace_back(in_workspace(found->second, record.frame, record.scans[i].scan_offset_m));
    else
      poses.push_back(scan.world_from_scan);
  }
  const bool none =
      std::none_of(poses.begin(), poses.end(), [](const auto& pose) { return pose.has_value(); });
  if (!named.empty() && none) log::warn("{}: names none of the scans", file.string());
  return poses;
}

void write_records(const std::vector<RangeScan>& scans, const io::WorkspaceFrame& frame,
                   const registration::Registration& result, pipeline::StageRun& run) {
  io::PosesRecord record{frame, {}, {}};
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const registration::PlacedScan& placed = result.scans[i];
    record.scans.push_back({scans[i].file, scans[i].index_in_file, placed.world_from_scan, placed.placed,
                            placed.reason, placed.rms_m, placed.overlap});
    if (placed.placed) continue;
    log::warn("{} is not placed: {}", scans[i].file, placed.reason);
    run.needs_review(fmt::format("{} is not placed: {}", scans[i].file, placed.reason));
  }
  for (const registration::SearchedPair& pair : result.searched)
    record.pairs.push_back({pair.first, pair.second, pair.rms_m, pair.overlap, pair.seen_through,
                            pair.in_void, pair.hold, pair.accepted, pair.reason});
  io::write_poses(run.output("poses.json"), record);
  io::write_cloud_ply(run.output("cloud.ply"), result.merged);
}

void run(const registration::RegisterOptions& options, pipeline::StageRun& run) {
  const std::vector<RangeScan> scans = ingested_scans(run);
  const io::ScansRecord record = io::read_scans_record(run.artifact("ingest", "scans.json"));
  const auto given = given_poses(scans, record, run.input());
  const registration::Registration result =
      registration::register_scans(scans, given, options, run.progress());
  const auto placed = std::count_if(result.scans.begin(), result.scans.end(),
                                    [](const registration::PlacedScan& scan) { return scan.placed; });
  if (placed == 0) throw input_error("no scan could be placed: none has points");
  write_records(scans, record.frame, result, run);
  double worst_rms = 0;
  for (const registration::PlacedScan& scan : result.scans) worst_rms = std::max(worst_rms, scan.rms_m);
  run.metric("scans_placed", static_cast<double>(placed));
  run.metric("scans_unplaced", static_cast<double>(scans.size()) - static_cast<double>(placed));
  run.metric("points", static_cast<double>(result.merged.size()));
  run.metric("worst_rms_m", worst_rms);
}

}  // namespace

pipeline::Stage register_stage() {
  pipeline::Stage stage;
  stage.name = "register";
  stage.version = 6;
  stage.summary =
      "Puts all scans into one frame: by given poses, or by the shape of the surfaces; refined on the scans' "
      "overlaps.";
  stage.input_parts = {"poses"};
  stage.reads = {{"ingest", "scans.json"}, {"ingest", "scans/*.ply"}};
  stage.writes = {"poses.json", "cloud.ply"};
  stage.applies = [](const pipeline::Input& input) { return !input.scans.empty(); };
  stage.instantiate = pipeline::stage_body(run);
  return stage;
}

}  // namespace drape::stages
