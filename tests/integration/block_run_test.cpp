// Photos whose cameras another program knows among themselves.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "drape/base/files.hpp"
#include "drape/io/camera_sidecars.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/model_files.hpp"
#include "drape/io/records.hpp"
#include "program.hpp"
#include "support.hpp"

namespace drape::test {
namespace {

namespace fs = std::filesystem;

/// The sample teapot's mesh with its two photos, and COLMAP's files of their cameras in a frame of their own.
class BlockRun {
 public:
  BlockRun(double scale, const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
    const std::string sample = source("sample_scans/teapot").string();
    write_file(scratch_ / "teapot.yaml",
               "input:\n  mesh: " + sample + "/truth_mesh.ply\n  units: mm\n  cameras: block/images.txt\n" +
                   "  photos:\n    - {image: " + sample + "/photos/000.jpg, mask: " + sample +
                   "/photos/000_stencil.png}\n    - {image: " + sample + "/photos/001.jpg, mask: " + sample +
                   "/photos/001_stencil.png}\n");
    std::vector<io::SidecarCamera> block;
    for (const io::CameraRecord& record : truth_.cameras) {
      Camera camera = record.camera;
      Rigid3& pose = camera.camera_from_world;
      // x_block = scale * rotation * x + translation, of x in metres without an offset.
      pose.translation() -= pose.linear() * truth_.frame.world_offset_m;
      pose.linear() = (pose.linear() * rotation.transpose()).eval();
      pose.translation() = (scale * pose.translation() - pose.linear() * translation).eval();
      block.push_back({record.photo, camera});
    }
    io::write_colmap(scratch_ / "block", block);
  }

  [[nodiscard]] Outcome operator()(const std::string& block, const std::string& until = "align",
                                   const std::string& setting = "texture.mode=auto") const {
    return run_drape({"run", (scratch_ / "teapot.yaml").string(), "--progress=plain", "--until", until,
                      "--workspace", (scratch_ / "workspace").string(), "--set", "align.block=" + block,
                      "--set", setting});
  }
  [[nodiscard]] io::CamerasRecord found() const {
    for (const auto& entry : fs::directory_iterator(scratch_ / "workspace/runs/teapot"))
      if (entry.path().filename().string().ends_with("-align"))
        return io::read_cameras(entry.path() / "cameras.json");
    return {};
  }
  /// Root mean square over the mesh's vertices, in pixels.
  [[nodiscard]] double error_px(std::size_t photo) const {
    const io::CamerasRecord cameras = found();
    double squares = 0;
    const TriangleMesh mesh = io::read_mesh(source("sample_scans/teapot/truth_mesh.ply"));  // millimetres
    for (const Eigen::Vector3d& x : mesh.vertices)
      squares += (cameras.cameras.at(photo).camera.project(0.001 * x - cameras.frame.world_offset_m).pixel -
                  truth_.cameras.at(photo).camera.project(0.001 * x - truth_.frame.world_offset_m).pixel)
                     .squaredNorm();
    return std::sqrt(squares / static_cast<double>(mesh.vertices.size()));
  }
  [[nodiscard]] fs::path file(const std::string& name) const { return scratch_ / name; }

 private:
  ScratchFolder scratch_;
  io::CamerasRecord truth_ = io::read_cameras(source("sample_scans/teapot/truth.json"));
};

TEST(BlockRun, ColmapsCamerasAreBroughtToTheMesh) {
  const BlockRun run(3.7, Eigen::AngleAxisd(1.9, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix(),
                     {5, -2, 8});
  const Outcome outcome = run("auto");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const io::CamerasRecord found = run.found();
  ASSERT_EQ(found.cameras.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(found.cameras[i].method, "block");
    EXPECT_EQ(found.cameras[i].verdict, io::Verdict::accept) << found.cameras[i].reasons.at(0);
    EXPECT_LT(run.error_px(i), 1);
  }
  EXPECT_EQ(stages_that_ran(run("auto")), std::vector<std::string>{});
  // The lens is in the file beside the one that is named.
  write_file(run.file("block/cameras.txt"), read_file(run.file("block/cameras.txt")) + "# another byte\n");
  EXPECT_EQ(stages_that_ran(run("auto")), std::vector<std::string>{"align"});
}

TEST(BlockRun, CamerasInTheFrameOfTheMeshAreTakenAsTheyAre) {
  const BlockRun run(1000, Eigen::Matrix3d::Identity(), {0, 0, 0});  // millimetres, as the mesh
  const Outcome outcome = run("given");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(run.found().cameras.at(1).method, "given");
  EXPECT_LT(run.error_px(0), 1e-6);
  EXPECT_LT(run.error_px(1), 1e-6);
}

TEST(BlockRun, AnAtlasThatIsTooSmallForThePhotosIsSaid) {
  const BlockRun run(1, Eigen::Matrix3d::Identity(), {0, 0, 0});
  const Outcome fits = run("auto", "texture");
  ASSERT_EQ(fits.exit_code, 0) << fits.err;
  EXPECT_EQ((fits.out + fits.err).find("atlas_size_px"), std::string::npos) << fits.err;
  const Outcome small = run("auto", "texture", "texture.atlas_size_px=64");
  ASSERT_EQ(small.exit_code, 0) << small.err;
  EXPECT_NE((small.out + small.err).find("texture.atlas_size_px: 64 is too small"), std::string::npos)
      << small.out << small.err;
}

TEST(BlockRun, ModelsOfSixteenBitsComeWithTiffs) {
  const BlockRun run(1, Eigen::Matrix3d::Identity(), {0, 0, 0});
  const Outcome outcome = run("auto", "export", "texture.color_bits=16");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const fs::path model = run.file("teapot-model");
  const TexturedMesh read = io::read_textured_ply(model / "model.ply", {});
  EXPECT_FALSE(read.materials.at(0).deep_image.empty());
  EXPECT_NE(read_file(model / "model.mtl").find("map_Kd model_atlas_000_color.tif\n"), std::string::npos);
  EXPECT_TRUE(fs::exists(model / "model_atlas_000_color.tif"));
  EXPECT_FALSE(fs::exists(model / "model_atlas_000_color.png"));
  EXPECT_TRUE(fs::exists(model / "model.glb"));
}

TEST(BlockRun, CamerasElsewhereSeeNothingOfTheMesh) {
  const BlockRun run(1000, Eigen::Matrix3d::Identity(), {0, 0, 90000});  // far above, looking past it
  const Outcome outcome = run("given", "texture");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE((outcome.out + outcome.err).find("no photo sees the mesh"), std::string::npos)
      << outcome.out << outcome.err;
}

TEST(BlockRun, OnePhotoIsNoBlock) {
  const BlockRun run(1, Eigen::Matrix3d::Identity(), {0, 0, 0});
  std::string images = read_file(run.file("block/images.txt"));
  images.replace(images.find("001.jpg"), 7, "999.jpg");
  write_file(run.file("block/images.txt"), images);
  const Outcome outcome = run("similarity");
  EXPECT_EQ(outcome.exit_code, 64);
  EXPECT_NE(outcome.err.find("two photos at least"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace drape::test
