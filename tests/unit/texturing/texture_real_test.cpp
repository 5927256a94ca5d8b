#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "drape/base/files.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/rendering/renderer.hpp"
#include "painted_object.hpp"
#include "support.hpp"

namespace drape::texturing {
namespace {

Camera true_camera(const nlohmann::json& item, int width, int height) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      camera.K(r, c) = item["K"][r][c];
      camera.camera_from_world.linear()(r, c) = item["R"][r][c];
    }
    camera.camera_from_world.translation()[r] = item["t"][r];
  }
  camera.K(0, 2) += 0.5;  // pixel centres are at integers in that file
  camera.K(1, 2) += 0.5;
  return camera;
}

TEST(RealCan, LooksLikeItsPhotoFromItsCamera) {
  if (!test::have_data("photos/lmo/can.ply")) GTEST_SKIP() << "needs photos/lmo of DRAPE_TEST_DATA";
  const TriangleMesh mesh = io::read_mesh(test::data("photos/lmo/can.ply"));
  const io::Photo photo = io::read_photo(test::data("photos/lmo/can.png"));
  const auto poses = nlohmann::json::parse(read_file(test::data("photos/poses.json")));
  const Camera camera = true_camera(poses["items"][0], photo.rgb.width(), photo.rgb.height());
  rendering::Renderer renderer(mesh);
  const Image8 outline = renderer.stencil(camera);
  TextureOptions options;
  options.stencil_erode_px = 0;  // the outline is exact here, so the photo shows up to it
  TextureResult result =
      texture_mesh(mesh, mesh, std::vector<TextureView>{{photo.rgb, camera, outline, "can"}}, options);
  EXPECT_EQ(problem_of_model(result.model), "");
  EXPECT_EQ(result.background_texels_percent, 0);
  result.model.mesh.colors.clear();
  result.model.materials.back().flat_color = Eigen::Vector3f(1, 0, 1);
  rendering::TexturedStyle style;
  style.samples_per_side = 1;
  const Image8 again = rendering::render_textured(result.model, camera, style);
  double squares = 0;
  double painted = 0;
  double all = 0;
  for (int y = 0; y < outline.height(); ++y)
    for (int x = 0; x < outline.width(); ++x) {
      if (outline.at(x, y) != stencil::object) continue;
      all += 1;
      if (again.at(x, y, 0) > 250 && again.at(x, y, 1) < 5 && again.at(x, y, 2) > 250) continue;  // unseen
      painted += 1;
      for (int c = 0; c < 3; ++c)
        squares += std::pow(static_cast<double>(again.at(x, y, c)) - photo.rgb.at(x, y, c), 2);
    }
  ASSERT_GT(all, 10000);
  EXPECT_GT(painted / all, 0.88);  // the rest is steeper than 80 degrees or next to something in front of it
  // The pixels come back but for rounding, in texture coordinates and in bytes: half a step is 54 dB.
  EXPECT_GT(10 * std::log10(255 * 255 * 3 * painted / std::max(squares, 1e-9)), 54);
}

}  // namespace
}  // namespace drape::texturing
