#include <fmt/core.h>

#include <algorithm>

#include "cleaning_picture.hpp"
#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/log.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/ingest/clean_scan.hpp"
#include "drape/io/photo.hpp"
#include "drape/io/records.hpp"
#include "drape/io/scan_files.hpp"
#include "drape/stages/units.hpp"
#include "rows.hpp"

namespace drape::stages {
namespace {

io::ScanReadOptions read_options(const pipeline::Input& input) {
  io::ScanReadOptions options;
  options.columns = input.columns;
  options.most_points = static_cast<std::size_t>(input.max_points_per_scan);
  if (const auto& depth = input.depth) {
    options.depth = io::DepthCamera{
        {depth->focal_px[0], depth->focal_px[1]}, {}, depth->values_per_unit, depth->along_ray};
    if (depth->center_px) options.depth->center_px = Eigen::Vector2d(depth->center_px->data());
  }
  return options;
}

void scale_by(double factor, RangeScan& scan) {
  for (Eigen::Vector3d& point : scan.cloud.positions) point *= factor;
  if (scan.view.kind == ScanView::Kind::origin) scan.view.vector *= factor;
  if (scan.world_from_scan) scan.world_from_scan->translation() *= factor;
  scan.spacing *= factor;
}

// All scans in the input's units, with the poses that the configuration states in place of the files' own.
std::vector<RangeScan> read_all(const pipeline::Input& input, const Progress& progress) {
  std::vector<RangeScan> scans;
  for (std::size_t i = 0; i < input.scans.size(); ++i) {
    const pipeline::ScanInput& stated = input.scans[i];
    progress.update(static_cast<double>(i) / static_cast<double>(input.scans.size()),
                    stated.file.filename().string());
    for (RangeScan& scan : io::read_scans(stated.file, read_options(input))) {
      if (stated.metres_per_unit)
        scale_by(*stated.metres_per_unit / *pipeline::metres_per_unit(input.units), scan);
      if (stated.world_from_scan) {
        Rigid3 pose;
        pose.matrix() =
            Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(stated.world_from_scan->data());
        scan.world_from_scan = pose;
      }
      scans.push_back(std::move(scan));
    }
  }
  return scans;
}

// The photos that scan files carry, and the cameras that they state, for input.photos and input.cameras of a
// next run.
void take_photos_out(const io::WorkspaceFrame& frame, pipeline::StageRun& run) {
  io::CamerasRecord cameras{frame, {}};
  std::size_t count = 0;
  for (const pipeline::ScanInput& scan : run.input().scans)
    for (const io::EmbeddedPhoto& photo : io::read_embedded_photos(scan.file)) {
      const std::string name = three_digits(count++) + ".png";
      io::write_image(run.output("photos/" + name), photo.pixels);
      if (!photo.camera) continue;
      io::CameraRecord& record = cameras.cameras.emplace_back();
      record.photo = name;
      record.camera = *photo.camera;
      // x_file = (x_workspace + offset) / metres_per_unit, and a pinhole camera knows no scale.
      Rigid3& pose = record.camera.camera_from_world;
      pose.translation() =
          pose.translation() * frame.metres_per_input_unit + pose.linear() * frame.world_offset_m;
      record.method = "given";
      record.reasons = {"stated by " + scan.file.filename().string()};
    }
  if (count == 0) return;
  log::info(
      "{} photo(s) were taken out of the scan files, to photos/ in this stage's folder; name in input.photos "
      "those to be draped: align then looks first where the scan file says that they were taken",
      count);
  if (!cameras.cameras.empty()) io::write_cameras(run.output("photos/cameras.json"), cameras);
}

// Scans of one object are of one size, up to a few times; ten times is another unit in one of the files.
void compare_sizes(const std::vector<RangeScan>& scans) {
  const auto size = [](const RangeScan& scan) {
    return bounding_box(scan.cloud.positions).diagonal().norm();
  };
  const auto [least, most] = std::minmax_element(
      scans.begin(), scans.end(), [&](const auto& a, const auto& b) { return size(a) < size(b); });
  if (size(*most) > 10 * size(*least))
    log::warn(
        "the scans differ much in size: {} measures {:.4g} units across, {} {:.4g}; if they are in different "
        "units, state them (input.scans: {{file, units}})",
        most->file, size(*most), least->file, size(*least));
}

// A box that no scanner takes in one go tells of wrong units.
void doubt_units(const std::vector<RangeScan>& scans, const io::WorkspaceFrame& frame) {
  for (const RangeScan& scan : scans) {
    const double size_m = bounding_box(scan.cloud.positions).diagonal().norm() * frame.metres_per_input_unit;
    if (size_m >= 0.001 && size_m <= 2000) continue;
    log::warn("{} would measure {:.4g} m across; check input.units", scan.file, size_m);
    return;
  }
}

BoundingBox box_of(const std::vector<RangeScan>& scans) {
  BoundingBox box;
  for (const RangeScan& scan : scans) {
    const BoundingBox own = bounding_box(scan.cloud.positions);
    if (scan.world_from_scan && !own.isEmpty())
      box.extend(own.transformed(*scan.world_from_scan));
    else
      box.extend(own);
  }
  return box;
}

// What is taken off a scan's own coordinates (in metres), so that they are small whatever its frame is. A
// scan with a pose has a frame of its own; one without shares the world's, unless it lies near the origin
// already.
Eigen::Vector3d scan_offset(const io::WorkspaceFrame& frame, const RangeScan& scan) {
  const BoundingBox box = bounding_box(scan.cloud.positions);
  if (box.isEmpty()) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d center_m = box.center() * frame.metres_per_input_unit;
  if (scan.world_from_scan) return far_offset(box, frame.metres_per_input_unit);
  return (center_m - frame.world_offset_m).norm() < center_m.norm()
             ? frame.world_offset_m
             : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

void move_to(const io::WorkspaceFrame& frame, const Eigen::Vector3d& offset_m, RangeScan& scan) {
  scale_by(frame.metres_per_input_unit, scan);
  for (Eigen::Vector3d& point : scan.cloud.positions) point -= offset_m;
  if (scan.view.kind == ScanView::Kind::origin) scan.view.vector -= offset_m;
  // x_world = R x_scan + t, with each side shifted by its own offset.
  if (scan.world_from_scan)
    scan.world_from_scan->translation() += scan.world_from_scan->linear() * offset_m - frame.world_offset_m;
}

// The crop box is stated in the units of the scans.
ingest::CleanOptions moved_to(const io::WorkspaceFrame& frame, const Eigen::Vector3d& offset_m,
                              ingest::CleanOptions options) {
  for (std::size_t i = 0; i < options.crop_box.size(); ++i)
    options.crop_box[i] =
        options.crop_box[i] * frame.metres_per_input_unit - offset_m[static_cast<Eigen::Index>(i % 3)];
  return options;
}

void run(const ingest::CleanOptions& options, pipeline::StageRun& run) {
  std::vector<RangeScan> scans = read_all(run.input(), run.progress().part(0, 0.4));
  compare_sizes(scans);
  io::ScansRecord record;
  record.frame = workspace_frame(box_of(scans), run);
  doubt_units(scans, record.frame);
  std::size_t points = 0;
  std::size_t dropped = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    run.progress().update(0.4 + 0.6 * static_cast<double>(i) / static_cast<double>(scans.size()),
                          scans[i].file);
    const Eigen::Vector3d offset_m = scan_offset(record.frame, scans[i]);
    move_to(record.frame, offset_m, scans[i]);
    const ingest::CleanedScan cleaned =
        ingest::clean_scan(scans[i], moved_to(record.frame, offset_m, options), {});
    const RangeScan& scan = cleaned.scan;
    if (scan.cloud.empty())
      throw input_error("{}: scan {} has no points left after cleaning; loosen the ingest options", scan.file,
                        scan.index_in_file);
    io::write_scan_ply(run.output("scans/" + three_digits(i) + ".ply"), scan);
    write_file(run.output("cleaning/" + three_digits(i) + ".jpg"),
               io::encode_image(cleaning_picture(scans[i], scan, run.input().up), "jpg", 88));
    io::ScanRecord& entry = record.scans.emplace_back();
    entry.file = scan.file;
    entry.index_in_file = scan.index_in_file;
    entry.points = scan.cloud.size();
    if (scan.grid) entry.grid = {scan.grid->rows, scan.grid->columns};
    entry.view = scan.view;
    entry.scan_offset_m = offset_m;
    entry.spacing_m = scan.spacing;
    entry.dropped = cleaned.dropped;
    points += scan.cloud.size();
    for (const auto& [filter, count] : cleaned.dropped) dropped += count;
    scans[i] = RangeScan{};  // one scan at a time in memory from here on
  }
  take_photos_out(record.frame, run);
  io::write_scans(run.output("scans.json"), record);
  run.metric("scans", static_cast<double>(record.scans.size()));
  run.metric("points", static_cast<double>(points));
  run.metric("dropped_points", static_cast<double>(dropped));
}

}  // namespace

pipeline::Stage ingest_stage() {
  pipeline::Stage stage;
  stage.name = "ingest";
  stage.version = 6;
  stage.summary = "Reads the scans, drops bad points, and finds oriented normals.";
  stage.input_parts = {"scans", "units"};
  stage.writes = {"scans.json", "scans/*.ply", "cleaning/*.jpg", "photos/*.png", "photos/cameras.json"};
  stage.applies = [](const pipeline::Input& input) { return !input.scans.empty(); };
  stage.instantiate = pipeline::stage_body(run);
  return stage;
}

}  // namespace drape::stages
