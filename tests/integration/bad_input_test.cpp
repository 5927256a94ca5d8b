// Whatever is wrong with the input: one clear message that names the file, the right exit code, nothing
// half-written.
#include <gtest/gtest.h>

#include <algorithm>

#include "drape/base/files.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/photo.hpp"
#include "program.hpp"
#include "support.hpp"

namespace drape::test {
namespace {

namespace fs = std::filesystem;

// A project that is right: a small mesh, a photo of a bright disc, and its mask. Tests spoil one thing.
class BadInput : public ::testing::Test {
 protected:
  BadInput() {
    io::write_mesh_ply(folder_ / "ball.ply", sphere(0.1, 12));
    Image8 photo(96, 80, 3, 40);
    Image8 mask(96, 80, 1, stencil::background);
    for (int y = 0; y < 80; ++y)
      for (int x = 0; x < 96; ++x)
        if ((x - 48) * (x - 48) + (y - 40) * (y - 40) < 30 * 30) {
          photo.at(x, y, 0) = 220;
          mask.at(x, y) = stencil::object;
        }
    io::write_image(folder_ / "photo.png", photo);
    io::write_image(folder_ / "mask.png", mask);
    io::write_image(folder_ / "black.png", Image8(96, 80, 1, stencil::background));
    io::write_image(folder_ / "small.png", Image8(9, 8, 1, stencil::object));
  }

  Outcome run(const std::string& yaml) {
    write_file(folder_ / "c.yaml", yaml);
    return run_drape({"run", "c.yaml", "--progress=plain"}, folder_.path());
  }

  // Runs, and checks code, words, and that nothing is left half-written or published.
  void expect_refused(const std::string& yaml, int code, const std::vector<std::string>& words) {
    const Outcome outcome = run(yaml);
    EXPECT_EQ(outcome.exit_code, code) << outcome.err;
    for (const std::string& word : words)
      EXPECT_NE(outcome.err.find(word), std::string::npos) << "'" << word << "' in:\n" << outcome.err;
    std::size_t messages = 0;
    for (std::size_t at = outcome.err.find("drape: "); at != std::string::npos;
         at = outcome.err.find("drape: ", at + 1))
      ++messages;
    EXPECT_EQ(messages, 1U) << outcome.err;
    if (fs::exists(folder_ / "drape-workspace")) {
      for (const auto& entry : fs::recursive_directory_iterator(folder_ / "drape-workspace"))
        EXPECT_NE(entry.path().extension(), ".writing") << entry.path();
    }
    EXPECT_FALSE(fs::exists(folder_ / "c-model"));
  }

  static std::string mesh_config(const std::string& mesh) {
    return "input:\n  mesh: " + mesh + "\n  units: m\n";
  }
  static std::string scan_config(const std::string& scan) {
    return "input:\n  scans: [" + scan + "]\n  units: m\n";
  }
  static std::string photo_config(const std::string& photo, const std::string& mask = "mask.png") {
    return mesh_config("ball.ply") + "  photos:\n    - {image: " + photo + ", mask: " + mask + "}\n" +
           "align: {method: exhaustive, first_pass_step_deg: 120, max_candidates_percent: 1}\n";
  }

  ScratchFolder folder_;
};

TEST_F(BadInput, TheProjectItselfIsRight) {
  const Outcome outcome = run(photo_config("photo.png"));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(fs::exists(folder_ / "c-model/model.glb"));
}

TEST_F(BadInput, MissingFile) {
  expect_refused(mesh_config("none.ply"), 65, {"c.yaml:2:9: input.mesh = none.ply: no such file"});
  EXPECT_EQ(run_drape({"run", "no.yaml"}, folder_.path()).exit_code, 65);
}

TEST_F(BadInput, EmptyScan) {
  write_file(folder_ / "empty.ply",
             "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float "
             "z\nend_header\n");
  expect_refused(scan_config("empty.ply"), 65, {"empty.ply"});
  write_file(folder_ / "nothing.ply", "");
  expect_refused(scan_config("nothing.ply"), 65, {"nothing.ply"});
}

TEST_F(BadInput, TruncatedPly) {
  const std::string whole = read_file(folder_ / "ball.ply");
  write_file(folder_ / "half.ply", whole.substr(0, whole.size() / 2));
  expect_refused(mesh_config("half.ply"), 65, {"half.ply", "byte"});
  write_file(folder_ / "half.ply",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
             "z\nend_header\n0.00000 0.00000 0.00000\n1.00000 0.00000\n");
  expect_refused(scan_config("half.ply"), 65, {"half.ply:9"});
}

TEST_F(BadInput, PlyWhoseCountsLie) {
  write_file(folder_ / "lie.ply",
             "ply\nformat binary_little_endian 1.0\nelement vertex 4294967295\nproperty double x\nproperty "
             "double y\nproperty double z\nend_header\n");
  expect_refused(scan_config("lie.ply"), 65, {"lie.ply"});
}

TEST_F(BadInput, MeshWithAnIndexOutOfRange) {
  write_file(folder_ / "wrong.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 999999\n");
  expect_refused(mesh_config("wrong.obj"), 65, {"wrong.obj:4"});
}

TEST_F(BadInput, PhotoThatIsNoPicture) {
  write_file(folder_ / "text.jpg", "this is no picture");
  expect_refused(photo_config("text.jpg"), 65, {"text.jpg"});
}

TEST_F(BadInput, HeicPhotoNamesAConverter) {
  write_file(folder_ / "phone.heic", std::string("\0\0\0\x18"
                                                 "ftypheic\0\0\0\0mif1heic",
                                                 24));
  expect_refused(photo_config("phone.heic"), 65, {"phone.heic", "heif-convert"});
}

TEST_F(BadInput, EmptyStencil) {
  expect_refused(photo_config("photo.png", "black.png"), 65, {"black.png"});
}

TEST_F(BadInput, MaskOfAnotherSize) {
  expect_refused(photo_config("photo.png", "small.png"), 65, {"small.png", "96"});
}

TEST_F(BadInput, UnknownKeyAndValueOutOfRange) {
  expect_refused(
      mesh_config("ball.ply") + "fill:\n  max_hole_size_spacing: 3\n", 64,
      {"c.yaml:5:3: fill.max_hole_size_spacing: no such key; did you mean max_hole_size_spacings?"});
  expect_refused(mesh_config("ball.ply") + "fill:\n  max_hole_size_spacings: -3\n", 64,
                 {"c.yaml:5:27: fill.max_hole_size_spacings = -3: is -3; must be within"});
}

TEST_F(BadInput, WhatIsNoYaml) {
  expect_refused("input: [1, 2\n", 64, {"c.yaml:"});
}

TEST_F(BadInput, FoldersThatCannotBeWritten) {
  write_file(folder_ / "file", "x");
  expect_refused(mesh_config("ball.ply") + "output: file/model\n", 74, {"file/model"});
  expect_refused(mesh_config("ball.ply") + "workspace: file/space\n", 74, {"file/space"});
}

}  // namespace
}  // namespace drape::test
