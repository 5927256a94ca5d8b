#include "posed_scans.hpp"

#include <algorithm>

#include "drape/io/records.hpp"
#include "drape/io/scan_files.hpp"
#include "rows.hpp"

namespace drape::stages {

std::vector<RangeScan> ingested_scans(const pipeline::StageRun& run) {
  const io::ScansRecord record = io::read_scans_record(run.artifact("ingest", "scans.json"));
  std::vector<RangeScan> scans;
  for (std::size_t i = 0; i < record.scans.size(); ++i)
    scans.push_back(io::read_scan_ply(run.artifact("ingest", "scans/" + three_digits(i) + ".ply")));
  return scans;
}

PosedScans placed_scans(const pipeline::StageRun& run) {
  const io::PosesRecord poses = io::read_poses(run.artifact("register", "poses.json"));
  std::vector<RangeScan> scans = ingested_scans(run);
  PosedScans placed;
  for (std::size_t i = 0; i < scans.size() && i < poses.scans.size(); ++i) {
    if (!poses.scans[i].placed) continue;
    placed.scans.push_back(std::move(scans[i]));
    placed.world_from_scan.push_back(poses.scans[i].world_from_scan);
  }
  return placed;
}

double median_spacing_m(const pipeline::StageRun& run) {
  std::vector<double> spacings;
  for (const io::ScanRecord& scan : io::read_scans_record(run.artifact("ingest", "scans.json")).scans)
    spacings.push_back(scan.spacing_m);
  if (spacings.empty()) return 0;
  const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
  std::nth_element(spacings.begin(), middle, spacings.end());
  return *middle;
}

}  // namespace drape::stages
