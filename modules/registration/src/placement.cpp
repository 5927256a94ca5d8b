#include "placement.hpp"

#include <fmt/core.h>

namespace drape::registration {

std::string label(const RangeScan& scan) {
  return scan.index_in_file == 0 ? scan.file : fmt::format("{} (scan {})", scan.file, scan.index_in_file + 1);
}

std::vector<PlacedScan> place_given(std::span<const RangeScan> scans,
                                    std::span<const std::optional<Rigid3>> given_world_from_scan) {
  std::vector<PlacedScan> placed(scans.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const auto& pose = given_world_from_scan[i] ? given_world_from_scan[i] : scans[i].world_from_scan;
    if (scans[i].cloud.empty()) {
      placed[i].reason = "it has no points";
    } else if (pose) {
      placed[i].placed = true;
      placed[i].world_from_scan = *pose;
      placed[i].reason = "given pose";
    } else {
      placed[i].reason = "no pose was given";
    }
  }
  return placed;
}

}  // namespace drape::registration
