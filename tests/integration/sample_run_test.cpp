// The samples that come with drape, from raw scans and a photo to a textured model.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cmath>

#include "drape/base/files.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/io/records.hpp"
#include "drape/metrics/stencil_agreement.hpp"
#include "drape/rendering/renderer.hpp"
#include "gltf_check.hpp"
#include "program.hpp"
#include "support.hpp"

namespace drape::test {
namespace {

namespace fs = std::filesystem;

// A run of config/<name>.yaml with its results in a scratch folder.
class SampleRun {
 public:
  explicit SampleRun(std::string name) : name_(std::move(name)) {}

  Outcome operator()(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {"run",
                                          source("config/" + name_ + ".yaml").string(),
                                          "--progress=plain",
                                          "--workspace",
                                          workspace().string(),
                                          "--set",
                                          "output=" + output().string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_drape(arguments);
  }
  [[nodiscard]] fs::path workspace() const { return scratch_ / "workspace"; }
  [[nodiscard]] fs::path output() const { return scratch_ / "model"; }
  [[nodiscard]] fs::path run_folder() const { return workspace() / "runs" / name_; }

 private:
  ScratchFolder scratch_;
  std::string name_;
};

// Overlap of the aligned model with the true stencil of sample_scans/<name>.
double true_overlap_percent(const SampleRun& run, const std::string& name) {
  const io::CamerasRecord cameras = io::read_cameras(run.output() / "cameras.json");
  const Camera& camera = cameras.cameras.at(0).camera;
  const TriangleMesh mesh = io::read_mesh(run.run_folder() / "4-fill/mesh.ply");
  const Image8 model = rendering::Renderer(mesh).stencil(camera);
  const Image8 truth = io::read_stencil(source("sample_scans/" + name + "/photos/000_stencil.png"),
                                        camera.width, camera.height);
  return metrics::stencil_overlap(truth, model).percent();
}

// How far the found camera shows the mesh from where the true one does, root mean square over the vertices,
// in pixels of the photo.
double camera_error_px(const SampleRun& run, const std::string& name) {
  const io::CamerasRecord found = io::read_cameras(run.run_folder() / "6-align/cameras.json");
  const io::CamerasRecord truth = io::read_cameras(source("sample_scans/" + name + "/truth.json"));
  const TriangleMesh mesh = io::read_mesh(run.run_folder() / "4-fill/mesh.ply");
  const Eigen::Vector3d to_true_world = found.frame.world_offset_m - truth.frame.world_offset_m;
  double squares = 0;
  for (const Eigen::Vector3d& x : mesh.vertices)
    squares += (found.cameras.at(0).camera.project(x).pixel -
                truth.cameras.at(0).camera.project(x + to_true_world).pixel)
                   .squaredNorm();
  return std::sqrt(squares / static_cast<double>(mesh.vertices.size()));
}

void expect_whole_model(const SampleRun& run) {
  for (const char* file : {"model.glb", "model.obj", "model.mtl", "model.ply", "cameras.json"})
    EXPECT_TRUE(fs::exists(run.output() / file)) << file;
  EXPECT_EQ(gltf_problems(run.output() / "model.glb"), std::vector<std::string>{});
  const std::string page = read_file(run.run_folder() / "report.html");
  for (const char* stage : {"ingest", "register", "mesh", "fill", "segment", "align", "texture", "export"})
    EXPECT_NE(page.find(stage), std::string::npos) << stage;
  EXPECT_NE(page.find("data:image/"), std::string::npos);
}

TEST(SampleRun, TeapotFromScansAndPhoto) {
  const SampleRun teapot("teapot");
  const Outcome first = teapot();
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_EQ(stages_that_ran(first), (std::vector<std::string>{"ingest", "register", "mesh", "fill", "segment",
                                                              "align", "texture", "export"}));
  expect_whole_model(teapot);
  EXPECT_GE(true_overlap_percent(teapot, "teapot"), 98.0);
  EXPECT_LE(camera_error_px(teapot, "teapot"), 8.0);
  EXPECT_NE(first.out.find("overlap  "), std::string::npos) << first.out;
  EXPECT_NE(first.out.find("model.glb"), std::string::npos) << first.out;

  EXPECT_EQ(stages_that_ran(teapot()), std::vector<std::string>{});
  // An option of a late stage runs that stage and what follows; what it runs is what explain says.
  const std::vector<std::string> set = {"--set", "texture.max_incidence_deg=60"};
  const Outcome explained = run_drape({"explain", source("config/teapot.yaml").string(), "--workspace",
                                       teapot.workspace().string(), set[0], set[1]});
  const std::size_t texture = explained.out.find("texture   would run, about ");
  ASSERT_NE(texture, std::string::npos) << explained.out;
  const std::size_t reason = explained.out.find('\n', texture) + 1;
  EXPECT_EQ(explained.out.find("            option texture.max_incidence_deg: ", reason), reason)
      << explained.out;
  EXPECT_NE(explained.out.find("align     is up to date"), std::string::npos) << explained.out;
  EXPECT_EQ(stages_that_ran(teapot(set)), (std::vector<std::string>{"texture", "export"}));
  // A limit that no hole comes near changes no byte of the mesh: nothing after `fill` runs.
  EXPECT_EQ(stages_that_ran(teapot({"--set", "fill.min_component_percent=0.001"})),
            std::vector<std::string>{"fill"});
  // The paint without the photo's light, for a viewer to light by the full mesh's shape.
  EXPECT_EQ(stages_that_ran(teapot({"--set", "texture.delight=true"})),
            (std::vector<std::string>{"texture", "export"}));
  EXPECT_EQ(gltf_problems(teapot.output() / "model_albedo.glb"), std::vector<std::string>{});
  const GltfPrimitive paint = read_gltf(teapot.output() / "model_albedo.glb").primitives.at(0);
  EXPECT_FALSE(paint.unlit);
  EXPECT_FALSE(paint.image.empty());
  EXPECT_FALSE(paint.normal_map.empty());
  EXPECT_NE(paint.image, read_gltf(teapot.output() / "model.glb").primitives.at(0).image);
  EXPECT_EQ(io::read_mesh(teapot.output() / "model_albedo.ply").faces,
            io::read_mesh(teapot.output() / "model.ply").faces);
  const Outcome status = run_drape({"status", teapot.workspace().string()});
  EXPECT_NE(status.out.find("teapot"), std::string::npos) << status.out;
}

TEST(SampleRun, StatueWithAHollowBackAndAGivenMask) {
  const SampleRun statue("statue");
  const Outcome outcome = statue();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  expect_whole_model(statue);
  EXPECT_GE(true_overlap_percent(statue, "statue"), 98.0);
  EXPECT_LE(camera_error_px(statue, "statue"), 8.0);
}

TEST(SampleRun, GridDelaunayOfEachScan) {
  const SampleRun statue("statue");
  const Outcome outcome = statue({"--set", "mesh.method=grid", "--set", "align.method=exhaustive", "--set",
                                  "align.first_pass_step_deg=90", "--set", "align.max_candidates_percent=1"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  expect_whole_model(statue);
}

TEST(SampleRun, SameBytesForAnyNumberOfThreads) {
  const std::vector<std::string> one = {"--threads", "1"};
  const std::vector<std::string> three = {"--threads", "3"};
  const SampleRun alone("teapot");
  const SampleRun together("teapot");
  ASSERT_EQ(alone(one).exit_code, 0);
  ASSERT_EQ(together(three).exit_code, 0);
  std::size_t compared = 0;
  for (const auto& entry : fs::recursive_directory_iterator(alone.workspace() / "stages")) {
    if (!entry.is_regular_file() || entry.path().filename() == "stage.json") continue;
    const fs::path twin =
        together.workspace() / "stages" / entry.path().lexically_relative(alone.workspace() / "stages");
    ASSERT_TRUE(fs::exists(twin)) << twin;
    EXPECT_TRUE(read_file(entry.path()) == read_file(twin))
        << entry.path().lexically_relative(alone.workspace());
    ++compared;
  }
  EXPECT_GE(compared, 20U);
}

TEST(SampleRun, AnInterruptLosesNothing) {
  const SampleRun teapot("teapot");
  const std::vector<std::string> arguments = {"run",
                                              source("config/teapot.yaml").string(),
                                              "--progress=plain",
                                              "--workspace",
                                              teapot.workspace().string(),
                                              "--set",
                                              "output=" + teapot.output().string(),
                                              "--until",
                                              "mesh"};
  const Outcome stopped = run_drape_and_signal(arguments, teapot.workspace().parent_path(), SIGTERM,
                                               teapot.workspace() / "stages" / "register");
  EXPECT_EQ(stopped.exit_code, 128 + SIGTERM) << stopped.err;
  for (const auto& entry : fs::recursive_directory_iterator(teapot.workspace()))
    EXPECT_NE(entry.path().extension(), ".writing");
  const Outcome again = teapot({"--until", "mesh"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(stages_that_ran(again).back(), "mesh");
}

}  // namespace
}  // namespace drape::test
