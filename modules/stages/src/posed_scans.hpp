// The scans that registration placed, as meshing wants them.
#pragma once

#include <vector>

#include "drape/geometry/range_scan.hpp"
#include "drape/geometry/rigid3.hpp"
#include "drape/pipeline/stage.hpp"

namespace drape::stages {

/// All scans of the ingest stage, in the order of scans.json.
[[nodiscard]] std::vector<RangeScan> ingested_scans(const pipeline::StageRun& run);

struct PosedScans {
  std::vector<RangeScan> scans;
  std::vector<Rigid3> world_from_scan;
};
/// Those of poses.json that are placed.
[[nodiscard]] PosedScans placed_scans(const pipeline::StageRun& run);

/// Median of the scans' spacings, in metres.
[[nodiscard]] double median_spacing_m(const pipeline::StageRun& run);

}  // namespace drape::stages
