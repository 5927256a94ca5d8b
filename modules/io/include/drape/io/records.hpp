// The JSON files that stages hand to each other and to other tools. One struct per file; the fields are the
// JSON's.
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drape/geometry/camera.hpp"
#include "drape/geometry/range_scan.hpp"
#include "drape/geometry/rigid3.hpp"

namespace drape::io {

/// What workspace coordinates mean: metres, shifted. x_workspace = x_input * metres_per_input_unit -
/// world_offset_m.
struct WorkspaceFrame {
  Eigen::Vector3d world_offset_m = Eigen::Vector3d::Zero();
  double metres_per_input_unit = 1.0;

  [[nodiscard]] Eigen::Vector3d from_input(const Eigen::Vector3d& x) const {
    return x * metres_per_input_unit - world_offset_m;
  }
  [[nodiscard]] Eigen::Vector3d to_input(const Eigen::Vector3d& x) const {
    return (x + world_offset_m) / metres_per_input_unit;
  }
};

/// scans.json
struct ScanRecord {
  std::string file;  // base name
  int index_in_file = 0;
  std::size_t points = 0;
  std::optional<std::array<int, 2>> grid;  // rows, columns
  ScanView view;
  double spacing_m = 0;
  std::map<std::string, std::size_t> dropped;  // filter -> points
  // Taken off the scan's own coordinates in metres; the world's are shifted by the frame's offset.
  Eigen::Vector3d scan_offset_m = Eigen::Vector3d::Zero();
};
struct ScansRecord {
  WorkspaceFrame frame;
  std::vector<ScanRecord> scans;  // scans[i] lies in scans/<i, three digits>.ply
};
void write_scans(const std::filesystem::path& file, const ScansRecord& record);
/// Error{input} naming the file and the member that is missing or wrong; so for all readers here.
[[nodiscard]] ScansRecord read_scans_record(const std::filesystem::path& file);

/// poses.json
struct PoseRecord {
  std::string file;
  int index_in_file = 0;
  Rigid3 world_from_scan = Rigid3::Identity();
  bool placed = true;
  std::string reason;  // why it is where it is, or why it is not placed
  double rms_m = 0;    // point-to-plane residual of its overlap with the others
  double overlap = 0;  // share of its points that lie on another scan's surface, 0..1
};
/// Two scans that were compared without a guess.
struct PairRecord {
  std::size_t first = 0;  // in the order of scans.json
  std::size_t second = 0;
  double rms_m = 0;
  double overlap = 0;       // the larger of the two shares of points on the other's surface, 0..1
  double seen_through = 0;  // the larger of the two shares that lies where the other looked through, 0..1
  double in_void = 0;       // the same of what lies where the other saw nothing at all
  double hold = 0;          // how firmly what they share holds one on the other; 0 where it slides on itself
  bool accepted = false;    // "verdict": "accept" or "reject"
  std::string reason;       // why not
};
struct PosesRecord {
  WorkspaceFrame frame;
  std::vector<PoseRecord> scans;  // in the order of scans.json
  std::vector<PairRecord> pairs;  // empty where poses were given
};
void write_poses(const std::filesystem::path& file, const PosesRecord& record);
[[nodiscard]] PosesRecord read_poses(const std::filesystem::path& file);

/// holes.json: the boundary loops that the mesh had, and what became of each; also the frame of the mesh
/// beside it.
struct HoleRecord {
  std::size_t boundary_edges = 0;
  double length_m = 0;         // of the boundary
  double length_spacings = 0;  // the same in point spacings: what the limit is compared with
  double area_m2 = 0;          // that it spans
  double flatness_m = 0;       // RMS distance of the boundary from its mean plane
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  std::string action;  // fair, plain, flat, leave
  std::string why;     // "shorter than max_hole_size_spacings", "outer border of an open scan", ...
  std::size_t faces_added = 0;
};
struct HolesRecord {
  WorkspaceFrame frame;
  double spacing_m = 0;
  std::vector<HoleRecord> holes;
};
void write_holes(const std::filesystem::path& file, const HolesRecord& record);
[[nodiscard]] HolesRecord read_holes(const std::filesystem::path& file);

/// cameras.json
enum class Verdict { accept, review, reject };
[[nodiscard]] std::string to_string(Verdict verdict);

struct CameraCandidate {
  Eigen::Matrix<double, 3, 4> P = Eigen::Matrix<double, 3, 4>::Zero();
  double overlap_percent = 0;
  double score = 0;
  Verdict verdict = Verdict::review;
};
struct CameraSigma {
  double rotation_deg = 0;
  double direction_deg = 0;
  double focal_percent = 0;
};
struct CameraRecord {
  std::string photo;  // base name
  Camera camera;      // workspace frame
  double overlap_percent = 0;
  std::optional<double> boundary_error_px;
  std::optional<double> edge_support;
  Verdict verdict = Verdict::review;
  std::vector<std::string> reasons;
  std::string evidence;  // stencil, segments, colour
  std::string method;    // exhaustive, silhouette, given
  std::string stencil;   // the final stencil, relative to cameras.json
  std::optional<CameraSigma> sigma;
  std::vector<CameraCandidate> candidates;
};
struct CamerasRecord {
  WorkspaceFrame frame;
  std::vector<CameraRecord> cameras;  // in the order of input.photos
};
void write_cameras(const std::filesystem::path& file, const CamerasRecord& record);
[[nodiscard]] CamerasRecord read_cameras(const std::filesystem::path& file);

}  // namespace drape::io
