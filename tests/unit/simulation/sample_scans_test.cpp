// The samples that come with the project are what their truth says.
#include <gtest/gtest.h>

#include <algorithm>

#include "drape/io/mesh_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/io/records.hpp"
#include "drape/io/scan_files.hpp"
#include "drape/metrics/distribution.hpp"
#include "drape/metrics/surface_distance.hpp"
#include "drape/rendering/renderer.hpp"
#include "support.hpp"

namespace drape::simulation {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

class EverySample : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(SampleScans, EverySample, testing::Values("teapot", "statue"),
                         [](const auto& test) { return test.param; });

TEST_P(EverySample, ScansLieOnTheTrueMeshWithinTheirNoise) {
  const fs::path folder = test::source("sample_scans/" + GetParam());
  const io::PosesRecord truth = io::read_poses(folder / "truth.json");
  TriangleMesh mesh = io::read_mesh(folder / "truth_mesh.ply");
  for (Vector3d& vertex : mesh.vertices) vertex *= truth.frame.metres_per_input_unit;
  ASSERT_GE(truth.scans.size(), 8U);
  double farthest = 0;
  for (const io::PoseRecord& pose : truth.scans) {
    const RangeScan scan = io::read_scans(folder / "scans" / pose.file).at(0);
    ASSERT_GT(scan.cloud.size(), 3000U) << pose.file;
    std::vector<Vector3d> points;
    for (const Vector3d& p : scan.cloud.positions)
      points.push_back(pose.world_from_scan * (truth.frame.metres_per_input_unit * p));
    std::vector<double> distances = metrics::distances_to_surface(points, mesh);
    std::sort(distances.begin(), distances.end());
    // Noise of 0.1 mm or less along the ray: its distance to the surface does not grow with incidence.
    EXPECT_LT(distances[distances.size() / 2], 0.0001) << pose.file;
    EXPECT_LT(distances[distances.size() * 95 / 100], 0.0004) << pose.file;
    farthest = std::max(farthest, distances.back());
  }
  EXPECT_GT(farthest, 0.005) << "no mixed pixels";
}

TEST_P(EverySample, PhotosShowTheTrueMeshWhereTheStencilIs) {
  const fs::path folder = test::source("sample_scans/" + GetParam());
  const io::CamerasRecord truth = io::read_cameras(folder / "truth.json");
  TriangleMesh mesh = io::read_mesh(folder / "truth_mesh.ply");
  for (Vector3d& vertex : mesh.vertices) vertex *= truth.frame.metres_per_input_unit;
  rendering::Renderer renderer(mesh);
  ASSERT_GE(truth.cameras.size(), 1U);
  for (const io::CameraRecord& record : truth.cameras) {
    const Camera& camera = record.camera;
    const io::Photo photo = io::read_photo(folder / "photos" / record.photo);
    EXPECT_EQ(photo.rgb.width(), camera.width);
    EXPECT_EQ(photo.rgb.height(), camera.height);
    const Image8 stencil = io::read_stencil(folder / record.stencil, camera.width, camera.height);
    const Image8 drawn = renderer.stencil(camera);
    int both = 0;
    int any = 0;
    for (std::size_t i = 0; i < drawn.data().size(); ++i) {
      const bool a = drawn.data()[i] == stencil::object;
      const bool b = stencil.data()[i] == stencil::object;
      both += a && b;
      any += a || b;
    }
    EXPECT_GT(static_cast<double>(both) / any, 0.999);
  }
}

TEST_P(EverySample, GivenPosesAreNearTheTrueOnes) {
  const fs::path folder = test::source("sample_scans/" + GetParam());
  const io::PosesRecord truth = io::read_poses(folder / "truth.json");
  const auto given = io::read_scan_poses(folder / "scans" / (GetParam() + ".conf"));
  ASSERT_EQ(given.size(), truth.scans.size());
  for (const io::PoseRecord& pose : truth.scans) {
    Rigid3 world_from_scan = given.at(pose.file);
    world_from_scan.translation() *= truth.frame.metres_per_input_unit;
    const double angle =
        Eigen::AngleAxisd((world_from_scan * pose.world_from_scan.inverse()).linear()).angle();
    EXPECT_LT(angle, 0.25 * 3.1416 / 180) << pose.file;
  }
}

TEST(SampleScans, AreSmall) {
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(test::source("sample_scans")))
    if (entry.is_regular_file()) bytes += entry.file_size();
  EXPECT_LT(bytes, 12'000'000U);
}

}  // namespace
}  // namespace drape::simulation
