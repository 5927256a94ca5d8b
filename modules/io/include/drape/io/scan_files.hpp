// Scan files: what range scanners write.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drape/geometry/bounding_box.hpp"
#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"
#include "drape/geometry/range_scan.hpp"
#include "drape/geometry/rigid3.hpp"

namespace drape::io {

/// The intrinsics of a depth camera: pinhole, pixel centres at +0.5.
struct DepthCamera {
  Eigen::Vector2d focal_px = Eigen::Vector2d::Zero();
  std::optional<Eigen::Vector2d> center_px;  // default: the picture's centre
  double values_per_unit = 1;                // of the picture's numbers, in one unit of the input
  bool along_ray = false;  // the numbers are distances from the camera, not depths along its axis
};

/// What a file cannot say itself.
struct ScanReadOptions {
  std::vector<std::string> columns;  // of points as text, by name: x, y, z, nx, ..., red, ..., intensity, "-"
  std::optional<DepthCamera> depth;  // of depth pictures
  std::size_t most_points = 0;       // a larger scan is thinned while it is read; 0: no limit
};

/// A row of the table of formats, as the README has it.
struct ScanFormatFacts {
  std::string_view name;
  std::string_view extensions;  // separated by blanks
  std::string_view reads;       // which dialects
  std::string_view keeps;       // of each point and scan, besides the points
  bool written = false;
};
[[nodiscard]] std::vector<ScanFormatFacts> scan_format_facts();

/// The row of scan_format_facts by which a file will be read. Error{input} where none does.
[[nodiscard]] ScanFormatFacts scan_format(const std::filesystem::path& file);

/// All scans of a file, in the file's own units and each in its own frame; scan_format_facts says which
/// formats. The dialect is told by the content where the format has a signature, else by the extension.
/// Points that are not finite are left out; a grid cell without a point is RangeGrid::missing. Normals are
/// brought to unit length, colours and intensities to 0..1. What was guessed of text is logged. Files of 64
/// MB and more are mapped, not loaded: they must not shrink while they are read.
///
/// `view` is what the file states: drape's own obj_info (view_origin x y z or view_direction x y z), a PLY's
/// `camera` element (view_px py pz) or a PCD's VIEWPOINT, also where that is the origin by default; the
/// scanner of PTX, 3DTK, depth pictures and of those E57 that have a grid or spherical coordinates. A PLY
/// with a range_grid that states none comes from Stanford's Cyberware scanner: parallel rays along -z.
/// Measured on the ten bunny scans: x is 0.5 mm a column at any depth (y shifts by 2 to 6 % of the depth, so
/// the rays tilt by up to 3 degrees along the columns), and 97 to 98 % of the surface at the points faces +z.
///
/// Error{input} with file and line or byte: missing or empty file, no points, counts that the bytes do not
/// hold (known before anything is allocated for them), a truncated file, data that go on after the last
/// declared row. Text that ends without a line end is read with a warning: its last number may have been cut.
[[nodiscard]] std::vector<RangeScan> read_scans(const std::filesystem::path& file,
                                                const ScanReadOptions& options = {});

/// The same of bytes in memory; `file` is named in errors, and its extension counts.
[[nodiscard]] std::vector<RangeScan> parse_scans(const std::filesystem::path& file, std::string_view bytes,
                                                 const ScanReadOptions& options = {});

/// A large scan by its header and a part of its points.
struct ScanSample {
  std::uint64_t points = 0;               // of the whole file
  RangeScan scan;                         // runs of consecutive points of the file, one after the other
  std::size_t run_points = 0;             // of a run, as the file has them
  std::optional<BoundingBox> stated_box;  // what the header says of all points
  int rows = 0;                           // of the grid; 0: none
  int columns = 0;
};
/// What can be told of a file without reading it whole: 262,144 points from 1,024 places. Nothing where the
/// format has no records of one size (only binary PLY without faces, binary PCD and LAS have), where the file
/// is small, or where its counts do not fit its bytes: then read_scans.
[[nodiscard]] std::optional<ScanSample> sample_scan(const std::filesystem::path& file);

/// A photo that a scan file carries.
struct EmbeddedPhoto {
  Image8 pixels;  // RGB or grey
  std::optional<Camera>
      camera;  // in the file's frame and units; where it is a pinhole picture with a focal length
};
/// The photos of an E57 (JPEG or PNG; pinhole pictures and visual references, not those that cover a sphere
/// or a cylinder), in its order; none of another format. Error{input} as read_scans.
[[nodiscard]] std::vector<EmbeddedPhoto> read_embedded_photos(const std::filesystem::path& file);
/// How many pictures an E57 says that it carries, of any form; 0 for another format.
[[nodiscard]] std::size_t count_embedded_photos(const std::filesystem::path& file);

/// Whether a file's name says that it holds poses of scans: .conf, .aln, .mlp.
[[nodiscard]] bool is_pose_file(const std::filesystem::path& file);

/// Poses of scans by a Stanford .conf, or a MeshLab .aln or .mlp: base name of the scan -> world_from_scan.
/// A .conf's quaternion is read so that p_world = R(q)^T p_scan + t (measured on the bunny: the transpose of
/// the usual matrix). Error{input} with file and line, also where a matrix is no rigid motion or a scan comes
/// twice.
[[nodiscard]] std::map<std::string, Rigid3> read_scan_poses(const std::filesystem::path& file);

/// Binary little-endian PLY with doubles: positions and every attribute that the cloud has; range_grid and
/// view (as obj_info) where the scan has them. What it writes, read_scans reads back to the same bits.
void write_scan_ply(const std::filesystem::path& file, const RangeScan& scan);
[[nodiscard]] RangeScan read_scan_ply(const std::filesystem::path& file);

/// PLY, PCD or points as text (.xyz, .txt, .csv, .asc) by extension: positions in full precision, normals,
/// colours and intensities. Error{config} for another extension.
void write_scan(const std::filesystem::path& file, const RangeScan& scan);

void write_cloud_ply(const std::filesystem::path& file, const PointCloud& cloud);
[[nodiscard]] PointCloud read_cloud_ply(const std::filesystem::path& file);

}  // namespace drape::io
