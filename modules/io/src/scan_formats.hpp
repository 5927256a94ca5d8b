// The scan formats: one file and one reader each, listed in the table of scan_files.cpp.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "drape/geometry/range_scan.hpp"
#include "drape/geometry/triangle_mesh.hpp"
#include "drape/io/scan_files.hpp"

namespace drape::io {

/// The bytes of a scan file, and how to read them. `file` is named in errors.
struct ScanSource {
  const std::string& file;
  std::string_view bytes;
  const ScanReadOptions& options;
};

/// All scans in the file. They may hold points that are not finite: read_scans leaves those out.
using ScanReader = std::vector<RangeScan> (*)(const ScanSource& source);

[[nodiscard]] std::vector<RangeScan> read_ply_scan(const ScanSource& source);
[[nodiscard]] std::vector<RangeScan> read_pcd_scan(const ScanSource& source);
[[nodiscard]] std::vector<RangeScan> read_xyz_scan(const ScanSource& source);
[[nodiscard]] std::vector<RangeScan> read_ptx_scan(const ScanSource& source);
[[nodiscard]] std::vector<RangeScan> read_las_scan(const ScanSource& source);
[[nodiscard]] std::vector<RangeScan> read_e57_scan(const ScanSource& source);
[[nodiscard]] std::vector<RangeScan> read_3dtk_scan(const ScanSource& source);
[[nodiscard]] std::vector<RangeScan> read_depth_scan(const ScanSource& source);
/// The vertices of a mesh file.
[[nodiscard]] std::vector<RangeScan> read_mesh_scan(const ScanSource& source);

/// What the content tells.
[[nodiscard]] bool looks_like_las(std::string_view bytes);
[[nodiscard]] bool looks_like_e57(std::string_view bytes);

/// The scan without the points that are not finite; grid cells are renumbered, or become missing.
[[nodiscard]] RangeScan without_bad_points(RangeScan scan);

}  // namespace drape::io
