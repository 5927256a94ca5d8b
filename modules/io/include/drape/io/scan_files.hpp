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
/// VIEWPOINT), points as text (.xyz .txt .csv .asc: separator, decimal comma, header and columns are guessed,
/// and the guess is logged). Points that are not finite are left out; a grid cell without a point is
/// RangeGrid::missing. Normals are brought to unit length, colours and intensities to 0..1.
///
/// `view` is what the file states: drape's own obj_info (view_origin x y z or view_direction x y z), a PLY's
/// `camera` element (view_px py pz) or a PCD's VIEWPOINT, also where that is the origin by default. A PLY
/// with a range_grid that states none comes from Stanford's Cyberware scanner: parallel rays along -z.
/// Measured on the ten bunny scans: x is 0.5 mm a column at any depth (y shifts by 2 to 6 % of the depth, so
/// the rays tilt by up to 3 degrees along the columns), and 97 to 98 % of the surface at the points faces +z.
///
/// Error{input} with file and line or byte: missing or empty file, no points, counts that the bytes do not
/// hold (known before anything is allocated for them), a truncated file, data that go on after the last
/// declared row. Text that ends without a line end is read with a warning: its last number may have been cut.
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
