#include "drape/simulation/simulation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "drape/base/files.hpp"
#include "drape/base/parallel.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/io/records.hpp"
#include "drape/io/scan_files.hpp"
#include "drape/metrics/surface_distance.hpp"
#include "drape/rendering/renderer.hpp"
#include "support.hpp"

namespace drape::simulation {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

SimulationSpec small_spec() {
  SimulationSpec spec;
  spec.mesh_detail = 2.5;
  spec.turntable_steps = 3;
  spec.scan_elevations_deg = {10, 50};
  spec.pitch_m = 0.005;
  spec.photo_azimuths_deg = {-70, 20};
  spec.photo_width = 96;
  spec.photo_height = 72;
  return spec;
}

std::map<std::string, std::string> all_files(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[entry.path().lexically_relative(folder).string()] = read_file(entry.path());
  return files;
}

TEST(Simulate, WritesTheSameBytesForAnyNumberOfThreads) {
  const test::ScratchFolder scratch;
  set_thread_count(1);
  simulate(small_spec(), scratch / "one");
  set_thread_count(3);
  simulate(small_spec(), scratch / "three");
  set_thread_count(0);
  const auto one = all_files(scratch / "one");
  EXPECT_EQ(one, all_files(scratch / "three"));
  std::vector<std::string> names;
  for (const auto& [name, bytes] : one) names.push_back(name);
  const std::vector<std::string> expected = {
      "photos/000.jpg", "photos/000_stencil.png", "photos/001.jpg",    "photos/001_stencil.png",
      "scans/000.ply",  "scans/001.ply",          "scans/002.ply",     "scans/003.ply",
      "scans/004.ply",  "scans/005.ply",          "scans/teapot.conf", "truth.json",
      "truth_mesh.ply"};
  EXPECT_EQ(names, expected);
}

TEST(Simulate, ScansByTheirTruePosesLieOnTheTrueMesh) {
  for (const Rays rays : {Rays::diverging, Rays::parallel}) {
    const test::ScratchFolder scratch;
    SimulationSpec spec = small_spec();
    spec.rays = rays;
    spec.noise_m = 0;
    spec.mixed_pixel_percent = 0;
    spec.photo_azimuths_deg = {};
    simulate(spec, scratch.path());
    const TriangleMesh mesh = io::read_mesh(scratch / "truth_mesh.ply");  // millimetres
    const io::PosesRecord truth = io::read_poses(scratch / "truth.json");
    ASSERT_EQ(truth.scans.size(), 6U);
    EXPECT_EQ(truth.frame.metres_per_input_unit, 0.001);
    for (const io::PoseRecord& pose : truth.scans) {
      const std::vector<RangeScan> scans = io::read_scans(scratch / "scans" / pose.file);
      ASSERT_EQ(scans.size(), 1U);
      ASSERT_TRUE(scans[0].grid);
      EXPECT_FALSE(scans[0].world_from_scan) << "the truth must not be in the scan";
      EXPECT_EQ(scans[0].view.kind,
                rays == Rays::diverging ? ScanView::Kind::origin : ScanView::Kind::direction);
      std::vector<Vector3d> points;
      for (const Vector3d& p : scans[0].cloud.positions)
        points.push_back(pose.world_from_scan * (0.001 * p) * 1000);
      EXPECT_GT(points.size(), 200U);
      // Floats of numbers up to 700 mm.
      EXPECT_LT(metrics::surface_distance(points, mesh).max, 1e-4);
    }
  }
}

TEST(Simulate, ConfHasThePosesWithTheErrorsAskedFor) {
  const test::ScratchFolder scratch;
  SimulationSpec spec = small_spec();
  spec.photo_azimuths_deg = {};
  spec.pose_error_deg = 0.5;
  spec.pose_error_m = 0.002;
  simulate(spec, scratch.path());
  const auto measured = io::read_scan_poses(scratch / "scans/teapot.conf");
  const io::PosesRecord truth = io::read_poses(scratch / "truth.json");
  const Vector3d center = 0.001 * bounding_box(io::read_mesh(scratch / "truth_mesh.ply").vertices).center();
  ASSERT_EQ(measured.size(), truth.scans.size());
  for (const io::PoseRecord& pose : truth.scans) {
    Rigid3 world_from_scan = measured.at(pose.file);
    world_from_scan.translation() *= 0.001;
    const Rigid3 error = world_from_scan * pose.world_from_scan.inverse();
    const double angle_deg = Eigen::AngleAxisd(error.linear()).angle() * 180 / std::numbers::pi;
    const bool first = pose.file == "000.ply";
    EXPECT_NEAR(angle_deg, first ? 0 : 0.5, 1e-5);
    EXPECT_NEAR((error * center - center).norm(), first ? 0 : 0.002, 1e-8);
  }
}

TEST(Simulate, CamerasSeeTheTrueMeshWhereTheStencilIs) {
  const test::ScratchFolder scratch;
  simulate(small_spec(), scratch.path());
  TriangleMesh mesh = io::read_mesh(scratch / "truth_mesh.ply");
  for (Vector3d& vertex : mesh.vertices) vertex *= 0.001;
  rendering::Renderer renderer(mesh);
  const io::CamerasRecord truth = io::read_cameras(scratch / "truth.json");
  ASSERT_EQ(truth.cameras.size(), 2U);
  for (const io::CameraRecord& record : truth.cameras) {
    const io::Photo photo = io::read_photo(scratch / "photos" / record.photo);
    EXPECT_EQ(photo.rgb.width(), 96);
    EXPECT_EQ(photo.rgb.height(), 72);
    const Image8 stencil = io::read_stencil(scratch / record.stencil, 96, 72);
    const Image8 drawn = renderer.stencil(record.camera);
    int different = 0;
    for (std::size_t i = 0; i < drawn.data().size(); ++i) different += drawn.data()[i] != stencil.data()[i];
    EXPECT_LT(different, 6);  // centres on the outline to rounding errors
  }
}

TEST(Simulate, UnitsAndScaleAreThoseOfTheFiles) {
  const test::ScratchFolder scratch;
  SimulationSpec spec = small_spec();
  spec.photo_azimuths_deg = {};
  spec.units = FileUnits::metres;
  spec.scale = 10;
  spec.distance_m = 7;
  spec.pitch_m = 0.05;
  simulate(spec, scratch.path());
  const BoundingBox box = bounding_box(io::read_mesh(scratch / "truth_mesh.ply").vertices);
  EXPECT_NEAR(box.sizes().x(), 2.25, 0.05);
  EXPECT_EQ(io::read_poses(scratch / "truth.json").frame.metres_per_input_unit, 1);
  const RangeScan scan = io::read_scans(scratch / "scans/000.ply").at(0);
  EXPECT_NEAR(bounding_box(scan.cloud.positions).center().z(), 7, 1);
}

TEST(Simulate, IntensityAndColourComeWithTheScans) {
  const test::ScratchFolder scratch;
  SimulationSpec spec = small_spec();
  spec.photo_azimuths_deg = {};
  spec.scan_intensity = true;
  spec.scan_color = true;
  simulate(spec, scratch.path());
  const RangeScan scan = io::read_scans(scratch / "scans/000.ply").at(0);
  EXPECT_EQ(scan.cloud.colors.size(), scan.cloud.size());
  EXPECT_EQ(scan.cloud.intensities.size(), scan.cloud.size());
}

TEST(Simulate, RefusesWhatMakesNoSense) {
  const test::ScratchFolder scratch;
  SimulationSpec spec = small_spec();
  spec.photo_azimuths_deg = {0, 90, 180};
  spec.photo_elevations_deg = {10, 20};
  EXPECT_NE(test::error_message(ErrorCode::config, [&] { simulate(spec, scratch.path()); })
                .find("photo_elevations_deg has 2 values"),
            std::string::npos);
  spec = small_spec();
  spec.distance_m = 0.05;
  EXPECT_NE(test::error_message(ErrorCode::config, [&] { simulate(spec, scratch.path()); })
                .find("inside the object"),
            std::string::npos);
}

TEST(Simulate, DoesNotMixWithOtherScans) {
  const test::ScratchFolder scratch;
  make_folder(scratch / "scans");
  write_file(scratch / "scans/mine.ply", "ply\n");
  const std::string message =
      test::error_message(ErrorCode::input, [&] { simulate(small_spec(), scratch.path()); });
  EXPECT_NE(message.find("mine.ply"), std::string::npos);
  EXPECT_EQ(all_files(scratch.path()).size(), 1U);
}

}  // namespace
}  // namespace drape::simulation
