// The scan formats: one file and one reader each, listed in the table of scan_files.cpp.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "drape/geometry/range_scan.hpp"

namespace drape::io {

/// All scans in the bytes of a file; `file` is named in errors. They may hold points that are not finite:
/// read_scans leaves those out.
using ScanReader = std::vector<RangeScan> (*)(const std::string& file, std::string_view bytes);

[[nodiscard]] std::vector<RangeScan> read_ply_scan(const std::string& file, std::string_view bytes);
[[nodiscard]] std::vector<RangeScan> read_pcd_scan(const std::string& file, std::string_view bytes);
[[nodiscard]] std::vector<RangeScan> read_xyz_scan(const std::string& file, std::string_view bytes);

/// The scan without the points that are not finite; grid cells are renumbered, or become missing.
[[nodiscard]] RangeScan without_bad_points(RangeScan scan);

}  // namespace drape::io
