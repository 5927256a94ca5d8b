// Real scans, a real mesh and a real photo, from the command line to the finished model.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "drape/base/files.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/model_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/io/records.hpp"
#include "drape/metrics/image_error.hpp"
#include "drape/metrics/stencil_agreement.hpp"
#include "drape/metrics/surface_distance.hpp"
#include "drape/rendering/renderer.hpp"
#include "gltf_check.hpp"
#include "program.hpp"
#include "support.hpp"

namespace drape::test {
namespace {

namespace fs = std::filesystem;

std::string yaml_quoted(const fs::path& path) {
  return "\"" + path.string() + "\"";
}

// The true camera of a photo in poses.json, in our convention of pixel centres at +0.5. Only the tests look
// at it.
Camera true_camera(const std::string& id, int width, int height) {
  const auto json = nlohmann::json::parse(read_file(data("photos/poses.json")));
  for (const auto& item : json.at("items")) {
    if (item.at("id") != id) continue;
    Camera camera;
    camera.width = width;
    camera.height = height;
    Eigen::Matrix3d rotation;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) {
        camera.K(r, c) = item.at("K").at(r).at(c);
        rotation(r, c) = item.at("R").at(r).at(c);
      }
    camera.K(0, 2) += 0.5;
    camera.K(1, 2) += 0.5;
    camera.camera_from_world.linear() = rotation;
    for (int r = 0; r < 3; ++r) camera.camera_from_world.translation()[r] = item.at("t").at(r);
    return camera;
  }
  throw std::out_of_range(id);
}

TEST(RealData, BunnyFromTenRawScansWithASimulatedPhoto) {
  if (!have_data("scans/bunny/bun.conf") || !have_data("meshes/bun_zipper.ply"))
    GTEST_SKIP() << "needs scans/bunny and meshes/bun_zipper.ply of DRAPE_TEST_DATA";
  const ScratchFolder folder;
  const TriangleMesh reference = io::read_mesh(data("meshes/bun_zipper.ply"));
  const Camera camera = look_at({0.25, 0.3, 0.45}, {-0.017, 0.11, 0}, {0, 1, 0}, 640, 480, 30);
  rendering::Renderer renderer(reference);
  io::write_image(folder / "photo.png", renderer.shaded(camera));
  io::write_image(folder / "mask.png", renderer.stencil(camera));
  write_file(folder / "bunny.yaml",
             "input:\n  scans: [" + yaml_quoted(data("scans/bunny/*.ply").string()) + "]\n  poses: " +
                 yaml_quoted(data("scans/bunny/bun.conf")) + "\n  units: m\n  up: y\n  photos:\n" +
                 "    - {image: photo.png, mask: mask.png}\nfill:\n  max_hole_size_spacings: 200\n");
  const Outcome outcome = run_drape({"run", "bunny.yaml"}, folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;

  const TriangleMesh mesh = io::read_mesh(folder / "drape-workspace/runs/bunny/3-mesh/mesh.ply");
  EXPECT_LT(metrics::surface_distance(mesh.vertices, reference).mean, 0.0005);
  EXPECT_LT(metrics::surface_distance(reference.vertices, mesh).mean, 0.0005);
  EXPECT_EQ(gltf_problems(folder / "bunny-model/model.glb"), std::vector<std::string>{});
  const io::CamerasRecord cameras = io::read_cameras(folder / "bunny-model/cameras.json");
  EXPECT_GT(cameras.cameras.at(0).overlap_percent, 93.0);
}

TEST(RealData, CanFromItsMeshPhotoAndMask) {
  if (!have_data("photos/lmo/can.ply")) GTEST_SKIP() << "needs photos/lmo of DRAPE_TEST_DATA";
  const ScratchFolder folder;
  const Image8 photo = io::read_photo(data("photos/lmo/can.png")).rgb;
  const TriangleMesh can = io::read_mesh(data("photos/lmo/can.ply"));
  const Image8 stencil =
      rendering::Renderer(can).stencil(true_camera("lmo_can", photo.width(), photo.height()));
  io::write_image(folder / "mask.png", stencil);
  write_file(folder / "can.yaml", "input:\n  mesh: " + yaml_quoted(data("photos/lmo/can.ply")) +
                                      "\n  units: mm\n  photos:\n    - image: " +
                                      yaml_quoted(data("photos/lmo/can.png")) + "\n      mask: mask.png\n");
  const Outcome outcome = run_drape({"run", "can.yaml"}, folder.path());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(gltf_problems(folder / "can-model/model.glb"), std::vector<std::string>{});

  // Seen from the camera that was found, the model must look like the photo where both show the can.
  const io::CamerasRecord cameras = io::read_cameras(folder / "can-model/cameras.json");
  const Camera& camera = cameras.cameras.at(0).camera;
  const fs::path run = folder / "drape-workspace/runs/can";
  const TexturedMesh model = io::read_textured_ply(run / "4-texture/model.ply", run / "4-texture/textures");
  const Image8 front = rendering::render_textured(model, camera);
  const Image8 model_stencil = rendering::Renderer(model.mesh).stencil(camera);
  EXPECT_GT(metrics::stencil_overlap(stencil, model_stencil).percent(), 90.0);
  Image8 inside(stencil.width(), stencil.height(), 1,
                0);  // off the outline, where one pixel is half background
  for (int y = 4; y + 4 < stencil.height(); ++y)
    for (int x = 4; x + 4 < stencil.width(); ++x) {
      bool all = true;
      for (int dy = -4; dy <= 4; ++dy)
        for (int dx = -4; dx <= 4; ++dx)
          all = all && stencil.at(x + dx, y + dy) != 0 && model_stencil.at(x + dx, y + dy) != 0;
      if (all) inside.at(x, y) = 255;
    }
  // The photo's colours lie where they belong to within a few pixels: the photo against itself, that much
  // off, is worse. (Surface at the rim that the photo sees too obliquely keeps the scan's own colours: no
  // perfect match.)
  Image8 shifted = photo;
  constexpr int shift_px = 4;
  for (int y = 0; y < photo.height(); ++y)
    for (int x = shift_px; x < photo.width(); ++x)
      for (int c = 0; c < 3; ++c) shifted.at(x, y, c) = photo.at(x - shift_px, y, c);
  const double found_db = metrics::psnr_db(photo, front, inside).value_or(0);
  EXPECT_GT(found_db, 22.0);
  EXPECT_GT(found_db, metrics::psnr_db(photo, shifted, inside).value_or(0));
}

}  // namespace
}  // namespace drape::test
