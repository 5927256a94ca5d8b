// Scans and poses as the Stanford 3D Scanning Repository has them.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "drape/geometry/range_scan.hpp"

namespace drape::simulation {

/// Binary little-endian PLY with float positions, range_grid, and the view as obj_info lines; intensity and
/// 8-bit colours where the cloud has them. Lengths are divided by metres_per_unit.
void write_range_ply(const std::filesystem::path& file, const RangeScan& scan, double metres_per_unit);

struct NamedPose {
  std::string scan;  // base name of its file
  Rigid3 world_from_scan;
};
/// Lines "bmesh file tx ty tz qx qy qz qw" with p_world = R(q)^T p_scan + t. Lengths are divided by
/// metres_per_unit.
void write_stanford_conf(const std::filesystem::path& file, const std::vector<NamedPose>& poses,
                         double metres_per_unit);

}  // namespace drape::simulation
