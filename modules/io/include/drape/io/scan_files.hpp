// Scan files: what range scanners write.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "drape/geometry/range_scan.hpp"
#include "drape/geometry/rigid3.hpp"

namespace drape::io {

/// All scans of a file, in the file's own units and each in its own frame. The dialect is told by the content
/// where the format has a signature, else by the extension: PLY (ASCII, binary of both byte orders; Stanford
/// range_grid; faces and unknown elements are skipped), PCD (ascii, binary, binary_compressed; organised;
/// VIEWPOINT), XYZ text. Points that are not finite are left out; a grid cell without a point is
/// RangeGrid::missing. Error{input} with file and line or byte offset: missing file, no points, counts that
/// the bytes do not hold.
[[nodiscard]] std::vector<RangeScan> read_scans(const std::filesystem::path& file);

/// Poses by a Stanford .conf: base name of the scan -> world_from_scan. The file's quaternion is read so that
/// p_world = R(q)^T p_scan + t (measured on the bunny: the transpose of the usual matrix).
[[nodiscard]] std::map<std::string, Rigid3> read_stanford_conf(const std::filesystem::path& file);

/// Binary little-endian PLY with doubles: positions and every attribute that the cloud has; range_grid and
/// view (as obj_info) where the scan has them. What it writes, read_scans reads back to the same bits.
void write_scan_ply(const std::filesystem::path& file, const RangeScan& scan);
[[nodiscard]] RangeScan read_scan_ply(const std::filesystem::path& file);

void write_cloud_ply(const std::filesystem::path& file, const PointCloud& cloud);
[[nodiscard]] PointCloud read_cloud_ply(const std::filesystem::path& file);

}  // namespace drape::io
