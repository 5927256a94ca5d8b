#include "drape/io/records.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "drape/base/files.hpp"
#include "support.hpp"

namespace drape {
namespace {

using test::error_message;
using test::ScratchFolder;

const io::WorkspaceFrame frame{{1e6 + 0.1, -2, 1.0 / 3}, 0.001};

TEST(Records, ScansReadBack) {
  const ScratchFolder folder;
  io::ScansRecord record;
  record.frame = frame;
  record.scans.push_back({"a \"b\"\n.ply",
                          2,
                          12345678901,
                          std::array<int, 2>{400, 512},
                          {ScanView::Kind::direction, {0, 0, -1}},
                          1.0 / 3,
                          {{"outliers", 7}, {"not_finite", 0}}});
  record.scans.push_back({"c.pcd", 0, 0, std::nullopt, {}, 0, {}});
  record.scans.push_back({"d.pcd", 0, 0, std::nullopt, {ScanView::Kind::origin, {1, 2, 0.1}}, 0, {}});
  io::write_scans(folder / "scans.json", record);
  const io::ScansRecord back = io::read_scans_record(folder / "scans.json");
  EXPECT_EQ(back.frame.world_offset_m, frame.world_offset_m);
  EXPECT_EQ(back.frame.metres_per_input_unit, frame.metres_per_input_unit);
  ASSERT_EQ(back.scans.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(back.scans[i].file, record.scans[i].file);
    EXPECT_EQ(back.scans[i].index_in_file, record.scans[i].index_in_file);
    EXPECT_EQ(back.scans[i].points, record.scans[i].points);
    EXPECT_EQ(back.scans[i].grid, record.scans[i].grid);
    EXPECT_EQ(back.scans[i].view.kind, record.scans[i].view.kind);
    EXPECT_EQ(back.scans[i].view.vector, record.scans[i].view.vector);
    EXPECT_EQ(back.scans[i].spacing_m, record.scans[i].spacing_m);
    EXPECT_EQ(back.scans[i].dropped, record.scans[i].dropped);
  }
}

TEST(Records, PosesReadBack) {
  const ScratchFolder folder;
  io::PosesRecord record;
  record.frame = frame;
  Rigid3 pose(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 1, 1).normalized()));
  pose.translation() = Eigen::Vector3d(0.1, 2e7, -3);
  record.scans.push_back({"a.ply", 0, pose, false, "no overlap", 1e-4, 0.7});
  record.scans.push_back({"b.ply", 0, pose, true, "", 0, 0});
  record.pairs.push_back({0, 1, 2e-4, 0.3, 0.02, 0.05, 0.07, false, "too far apart"});
  io::write_poses(folder / "poses.json", record);
  const io::PosesRecord back = io::read_poses(folder / "poses.json");
  ASSERT_EQ(back.scans.size(), 2U);
  ASSERT_EQ(back.pairs.size(), 1U);
  EXPECT_EQ(back.pairs[0].first, 0U);
  EXPECT_EQ(back.pairs[0].second, 1U);
  EXPECT_EQ(back.pairs[0].rms_m, 2e-4);
  EXPECT_EQ(back.pairs[0].overlap, 0.3);
  EXPECT_EQ(back.pairs[0].seen_through, 0.02);
  EXPECT_EQ(back.pairs[0].in_void, 0.05);
  EXPECT_EQ(back.pairs[0].hold, 0.07);
  EXPECT_FALSE(back.pairs[0].accepted);
  EXPECT_EQ(back.pairs[0].reason, "too far apart");
  EXPECT_EQ(back.scans[0].world_from_scan.matrix(), pose.matrix());
  EXPECT_FALSE(back.scans[0].placed);
  EXPECT_EQ(back.scans[0].reason, "no overlap");
  EXPECT_EQ(back.scans[0].rms_m, 1e-4);
  EXPECT_EQ(back.scans[0].overlap, 0.7);
}

TEST(Records, HolesReadBack) {
  const ScratchFolder folder;
  io::HolesRecord record;
  record.frame = frame;
  record.spacing_m = 5e-4;
  record.holes.push_back({12, 0.1, 33.3, 2.5, 0.02, {1, 2, 3}, "fair", "short", 10});
  record.holes.push_back({99, 5, 1e4, 7, 0.5, {0, 0, 0}, "leave", "outer border", 0});
  io::write_holes(folder / "holes.json", record);
  const io::HolesRecord back = io::read_holes(folder / "holes.json");
  EXPECT_EQ(back.spacing_m, 5e-4);
  ASSERT_EQ(back.holes.size(), 2U);
  EXPECT_EQ(back.holes[0].boundary_edges, 12U);
  EXPECT_EQ(back.holes[0].length_m, 0.1);
  EXPECT_EQ(back.holes[0].length_spacings, 33.3);
  EXPECT_EQ(back.holes[0].center, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(back.holes[0].area_m2, 2.5);
  EXPECT_EQ(back.holes[0].flatness_m, 0.02);
  EXPECT_EQ(back.holes[0].action, "fair");
  EXPECT_EQ(back.holes[0].faces_added, 10U);
  EXPECT_EQ(back.holes[1].why, "outer border");
}

io::CameraRecord camera_record() {
  io::CameraRecord record;
  record.photo = "front.jpg";
  record.camera = look_at({1, 2, 3}, {0.1, 0, 0}, {0, 0, 1}, 640, 480, 35);
  record.camera.K(1, 1) *= 1.01;
  record.overlap_percent = 97.5;
  record.edge_support = 0.8;
  record.verdict = io::Verdict::accept;
  record.reasons = {"good", "edges agree"};
  record.evidence = "stencil";
  record.method = "exhaustive";
  record.stencil = "000/stencil.png";
  record.sigma = io::CameraSigma{0.1, 0.2, 0.3};
  record.candidates.push_back({record.camera.P(), 90, 0.5, io::Verdict::reject});
  return record;
}

TEST(Records, CamerasReadBack) {
  const ScratchFolder folder;
  io::CamerasRecord record;
  record.frame = frame;
  record.cameras.push_back(camera_record());
  record.cameras.push_back(camera_record());
  record.cameras[1].camera.projection = Camera::Projection::orthographic;
  record.cameras[1].sigma.reset();
  record.cameras[1].boundary_error_px = 1.25;
  io::write_cameras(folder / "cameras.json", record);
  const io::CamerasRecord back = io::read_cameras(folder / "cameras.json");
  ASSERT_EQ(back.cameras.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const io::CameraRecord& a = record.cameras[i];
    const io::CameraRecord& b = back.cameras[i];
    EXPECT_EQ(b.photo, a.photo);
    EXPECT_EQ(b.camera.projection, a.camera.projection);
    EXPECT_EQ(b.camera.width, 640);
    EXPECT_EQ(b.camera.height, 480);
    EXPECT_EQ(b.camera.K, a.camera.K);
    EXPECT_EQ(b.camera.camera_from_world.matrix(), a.camera.camera_from_world.matrix());
    EXPECT_EQ(b.overlap_percent, a.overlap_percent);
    EXPECT_EQ(b.boundary_error_px, a.boundary_error_px);
    EXPECT_EQ(b.edge_support, a.edge_support);
    EXPECT_EQ(b.verdict, a.verdict);
    EXPECT_EQ(b.reasons, a.reasons);
    EXPECT_EQ(b.evidence, a.evidence);
    EXPECT_EQ(b.method, a.method);
    EXPECT_EQ(b.stencil, a.stencil);
    EXPECT_EQ(b.sigma.has_value(), a.sigma.has_value());
    ASSERT_EQ(b.candidates.size(), 1U);
    EXPECT_EQ(b.candidates[0].P, a.candidates[0].P);
    EXPECT_EQ(b.candidates[0].verdict, io::Verdict::reject);
  }
}

TEST(Records, TheContractHasTheseMembers) {
  const ScratchFolder folder;
  io::CamerasRecord record;
  record.cameras.push_back(camera_record());
  io::write_cameras(folder / "cameras.json", record);
  const std::string text = read_file(folder / "cameras.json");
  for (const char* name : {"units",
                           "world_offset_m",
                           "cameras",
                           "photo",
                           "width",
                           "height",
                           "projection",
                           "P",
                           "K",
                           "camera_from_world",
                           "focal_px",
                           "distortion",
                           "overlap_percent",
                           "boundary_error_px",
                           "edge_support",
                           "verdict",
                           "reasons",
                           "evidence",
                           "method",
                           "stencil",
                           "sigma",
                           "rotation_deg",
                           "direction_deg",
                           "focal_percent",
                           "candidates",
                           "score"})
    EXPECT_NE(text.find("\"" + std::string(name) + "\""), std::string::npos) << name;
}

TEST(Records, ErrorsNameTheMember) {
  const ScratchFolder folder;
  io::CamerasRecord record;
  record.cameras.push_back(camera_record());
  io::write_cameras(folder / "c.json", record);
  const std::string good = read_file(folder / "c.json");
  const auto problem = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    write_file(folder / "c.json", text.replace(at, from.size(), to));
    return error_message(ErrorCode::input, [&] { (void)io::read_cameras(folder / "c.json"); });
  };
  EXPECT_NE(problem("\"photo\"", "\"foto\"").find("cameras[0].photo: is missing"), std::string::npos);
  EXPECT_NE(problem("\"accept\"", "\"fine\"").find("cameras[0].verdict"), std::string::npos);
  EXPECT_NE(problem("\"units\": \"m\"", "\"units\": \"mm\"").find("units"), std::string::npos);
  EXPECT_NE(problem("640", "1e99").find("cameras[0].width"), std::string::npos);
  EXPECT_NE(problem("97.5", "\"much\"").find("cameras[0].overlap_percent: is no number"), std::string::npos);
  EXPECT_NE(problem("\"candidates\": [", "\"candidates\": [3,").find("cameras[0].candidates[0]"),
            std::string::npos);
  EXPECT_NE(problem("perspective", "fisheye").find("projection"), std::string::npos);
  write_file(folder / "c.json", "{\n\"units\": oops}");
  EXPECT_NE(error_message(ErrorCode::input, [&] { (void)io::read_cameras(folder / "c.json"); })
                .find("c.json:2: is no valid JSON"),
            std::string::npos);
  write_file(folder / "c.json", "");
  EXPECT_FALSE(error_message(ErrorCode::input, [&] { (void)io::read_cameras(folder / "c.json"); }).empty());
  write_file(folder / "c.json", std::string(200000, '['));
  EXPECT_FALSE(error_message(ErrorCode::input, [&] { (void)io::read_cameras(folder / "c.json"); }).empty());
  EXPECT_NE(
      error_message(ErrorCode::input, [&] { (void)io::read_poses(folder / "none.json"); }).find("none.json"),
      std::string::npos);
}

TEST(Records, ATruncatedFileNeverPasses) {
  const ScratchFolder folder;
  io::CamerasRecord record;
  record.cameras.push_back(camera_record());
  io::write_cameras(folder / "c.json", record);
  const std::string good = read_file(folder / "c.json");
  for (std::size_t size = 0; size + 2 < good.size(); size += 7) {
    write_file(folder / "c.json", good.substr(0, size));
    EXPECT_FALSE(error_message(ErrorCode::input, [&] { (void)io::read_cameras(folder / "c.json"); }).empty())
        << size;
  }
}

TEST(Records, ANumberThatIsNotFiniteIsABugOfTheCaller) {
  const ScratchFolder folder;
  io::HolesRecord record;
  record.spacing_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(
      error_message(ErrorCode::bug, [&] { io::write_holes(folder / "h.json", record); }).find("spacing_m"),
      std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "h.json"));
}

TEST(Records, AFileNameThatIsNotUtf8CanBeRecorded) {
  const ScratchFolder folder;
  io::PosesRecord record;
  record.scans.push_back({"M\xFCller.ply", 0, Rigid3::Identity(), true, "", 0, 0});
  io::write_poses(folder / "p.json", record);
  EXPECT_EQ(io::read_poses(folder / "p.json").scans.size(), 1U);
}

}  // namespace
}  // namespace drape
