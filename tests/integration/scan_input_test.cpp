// What is told of single scan files, in the configuration or by the file, from there to the result.
#include <gtest/gtest.h>

#include <fmt/core.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>

#include "drape/base/files.hpp"
#include "drape/base/numbers.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/io/records.hpp"
#include "drape/io/scan_files.hpp"
#include "program.hpp"
#include "scan_bytes.hpp"
#include "support.hpp"

namespace drape::test {
namespace {

namespace fs = std::filesystem;

constexpr double millimetre = 1e-3;

std::string sample(const std::string& file) {
  return source("sample_scans/teapot/" + file).string();
}

// Of the sample's scans, in millimetres.
std::vector<Rigid3> true_poses() {
  std::vector<Rigid3> poses;
  for (const io::PoseRecord& scan : io::read_poses(sample("truth.json")).scans) {
    poses.push_back(scan.world_from_scan);
    poses.back().translation() /= millimetre;
  }
  return poses;
}

std::string joined(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : ", ") + format_number(number);
  return text;
}

Outcome run_until(const std::string& stage, const fs::path& config, std::vector<std::string> more = {}) {
  more.insert(more.begin(), {"run", config.string(), "--progress=plain", "--until", stage, "--workspace",
                             (config.parent_path() / "workspace").string()});
  return run_drape(more);
}

// The scan with all its lengths times `factor`.
RangeScan scaled(RangeScan scan, double factor) {
  for (Eigen::Vector3d& p : scan.cloud.positions) p *= factor;
  if (scan.view.kind == ScanView::Kind::origin) scan.view.vector *= factor;
  scan.spacing = 0;
  return scan;
}

TEST(ScanInput, UnitsAndMotionOfOneFile) {
  const ScratchFolder folder;
  const std::vector<Rigid3> truth = true_poses();
  io::write_scan_ply(folder / "a.ply", scaled(io::read_scans(sample("scans/000.ply")).at(0), 1));
  io::write_scan_ply(folder / "b.ply", scaled(io::read_scans(sample("scans/001.ply")).at(0), 1 / 25.4));
  const Eigen::Matrix<double, 3, 4, Eigen::RowMajor> a = truth[0].matrix().topRows<3>();
  const Eigen::Quaterniond q(truth[1].linear());
  const Eigen::Vector3d t = truth[1].translation();
  write_file(folder / "two.yaml", "input:\n  units: mm\n  scans:\n    - {file: a.ply, transform: [" +
                                      joined({a.data(), a.data() + 12}) +
                                      "]}\n    - {file: b.ply, units: in, pose: [" +
                                      joined({t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z()}) + "]}\n");
  for (const char* method : {"given", "refine"}) {
    const Outcome outcome =
        run_until("register", folder / "two.yaml", {"--set", std::string("register.method=") + method});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const fs::path run = folder / "workspace/runs/two";
    const io::ScansRecord scans = io::read_scans_record(run / "1-ingest/scans.json");
    ASSERT_EQ(scans.scans.size(), 2U);
    EXPECT_NEAR(scans.scans[1].spacing_m, scans.scans[0].spacing_m, 0.05 * scans.scans[0].spacing_m);
    const io::PosesRecord poses = io::read_poses(run / "2-register/poses.json");
    for (std::size_t i = 0; i < 2; ++i) {
      const Rigid3& found = poses.scans.at(i).world_from_scan;
      const Eigen::Vector3d middle =
          io::read_scans(sample(i == 0 ? "scans/000.ply" : "scans/001.ply")).at(0).cloud.positions.at(1000);
      const Eigen::Vector3d in_world =
          found * (millimetre * middle - scans.scans[i].scan_offset_m) + poses.frame.world_offset_m;
      EXPECT_LT((in_world - millimetre * (truth[i] * middle)).norm(), 0.5 * millimetre) << method << i;
    }
    EXPECT_GT(poses.scans[1].overlap, 0.3);
    EXPECT_LT(poses.scans[1].rms_m, 1 * millimetre);
  }
}

// A pose as E57 has it; the frame's unit is the metre.
std::string pose_xml(const Rigid3& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const auto number = [](const char* name, double value) {
    return std::string("<") + name + " type=\"Float\">" + format_number(value) + "</" + name + ">";
  };
  return "<pose type=\"Structure\"><rotation type=\"Structure\">" + number("w", q.w()) + number("x", q.x()) +
         number("y", q.y()) + number("z", q.z()) + "</rotation><translation type=\"Structure\">" +
         number("x", pose.translation().x()) + number("y", pose.translation().y()) +
         number("z", pose.translation().z()) + "</translation></pose>";
}

// The sample's scans at their true places, and its photo, said to be taken from `world_from_camera`.
std::string teapot_e57(const Camera& camera, const Rigid3& world_from_camera) {
  E57Maker maker;
  const std::vector<Rigid3> truth = true_poses();
  for (std::size_t i = 0; i < truth.size(); i += 2) {
    const RangeScan scan = io::read_scans(sample("scans/" + fmt::format("{:03}", i) + ".ply")).at(0);
    Rigid3 pose = truth[i];
    pose.translation() *= millimetre;
    E57Maker::Scan& made = maker.scans.emplace_back();
    made.xml = pose_xml(pose);
    std::vector<std::uint64_t> rows(scan.cloud.size()), columns(scan.cloud.size());
    for (int row = 0; row < scan.grid->rows; ++row)
      for (int column = 0; column < scan.grid->columns; ++column)
        if (const std::int32_t cell = scan.grid->at(row, column); cell != RangeGrid::missing) {
          rows[static_cast<std::size_t>(cell)] = static_cast<std::uint64_t>(row);
          columns[static_cast<std::size_t>(cell)] = static_cast<std::uint64_t>(column);
        }
    const std::string range = " type=\"Integer\" minimum=\"0\" maximum=\"65535\"/>";
    made.fields = {{"<rowIndex" + range, 16, rows}, {"<columnIndex" + range, 16, columns}};
    for (int axis = 0; axis < 3; ++axis) {
      E57Maker::Field field{
          "<cartesian" + std::string(1, static_cast<char>('X' + axis)) + " type=\"Float\"/>", 64, {}};
      for (const Eigen::Vector3d& p : scan.cloud.positions)
        field.values.push_back(std::bit_cast<std::uint64_t>(millimetre * p[axis]));
      made.fields.push_back(field);
    }
  }
  maker.photo = io::encode_image(io::read_photo(sample("photos/000.jpg")).rgb, "png");
  maker.focal_x_px = camera.K(0, 0), maker.focal_y_px = camera.K(1, 1);
  maker.center_x_px = camera.K(0, 2), maker.center_y_px = camera.K(1, 2);
  // An E57's camera looks along its -z, with y up.
  maker.photo_pose = pose_xml(world_from_camera * Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));
  return maker.bytes();
}

TEST(ScanInput, AnEmbeddedPhotoIsAlignedNearWhereTheFileSays) {
  const io::CamerasRecord truth = io::read_cameras(sample("truth.json"));
  const Camera& camera = truth.cameras.at(0).camera;
  // By 4 degrees round a corner of the world, and by a centimetre.
  const Rigid3 off = Eigen::Translation3d(0.01, -0.005, 0) *
                     Eigen::AngleAxisd(4 * M_PI / 180, Eigen::Vector3d(1, 2, 3).normalized());
  const ScratchFolder folder;
  write_file(folder / "scans.e57", teapot_e57(camera, off * camera.camera_from_world.inverse()));
  const std::string input = "input:\n  units: m\n  scans: [scans.e57]\n";
  const std::string options = "register: {method: given}\n";
  write_file(folder / "pot.yaml", input + options);
  const Outcome first = run_until("ingest", folder / "pot.yaml");
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const fs::path run = folder / "workspace/runs/pot";
  const fs::path photo = run / "1-ingest/photos/000.png";
  ASSERT_TRUE(fs::exists(photo)) << first.err;
  fs::copy_file(photo, folder / "front.png");
  write_file(folder / "pot.yaml", input + "  photos:\n    - {image: front.png, mask: " +
                                      sample("photos/000_stencil.png") + "}\n" + options);
  const Outcome second = run_until("align", folder / "pot.yaml");
  ASSERT_EQ(second.exit_code, 0) << second.err;
  const io::CamerasRecord found = io::read_cameras(run / "6-align/cameras.json");
  const io::CameraRecord& record = found.cameras.at(0);
  EXPECT_EQ(record.verdict, io::Verdict::accept);
  EXPECT_NE(std::find(record.reasons.begin(), record.reasons.end(),
                      "found near the place that the scan file states"),
            record.reasons.end());
  const TriangleMesh mesh = io::read_mesh(sample("truth_mesh.ply"));
  const auto error_px = [&](const Camera& seen, const Eigen::Vector3d& offset) {
    double squares = 0;
    for (const Eigen::Vector3d& x : mesh.vertices)
      squares += (seen.project(millimetre * x - offset).pixel -
                  camera.project(millimetre * x - truth.frame.world_offset_m).pixel)
                     .squaredNorm();
    return std::sqrt(squares / static_cast<double>(mesh.vertices.size()));
  };
  Camera stated = camera;
  stated.camera_from_world = camera.camera_from_world * off.inverse();
  EXPECT_GT(error_px(stated, truth.frame.world_offset_m), 30);
  EXPECT_LT(error_px(record.camera, found.frame.world_offset_m), 5);
}

}  // namespace
}  // namespace drape::test
