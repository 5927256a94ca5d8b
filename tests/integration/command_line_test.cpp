#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "drape/base/files.hpp"
#include "drape/io/photo.hpp"
#include "program.hpp"
#include "support.hpp"

namespace drape::test {
namespace {

namespace fs = std::filesystem;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(CommandLine, VersionNamesTheLibraries) {
  const Outcome outcome = run_drape({"--version"});
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* name : {"drape ", "PCL ", "CGAL ", "OpenCV ", "Eigen ", "OSMesa ", "yaml-cpp "})
    EXPECT_TRUE(contains(outcome.out, name)) << name;
}

TEST(CommandLine, EveryHelpShowsAnExample) {
  for (const char* command : {"run", "status", "explain", "validate", "new", "make", "batch", "sweep", "gc",
                              "diff", "adopt", "reference", "simulate", "segment", "align", "relight"}) {
    const Outcome outcome = run_drape({command, "--help"});
    EXPECT_EQ(outcome.exit_code, 0) << command;
    EXPECT_TRUE(contains(outcome.out, std::string("Example:\n  drape ") + command)) << outcome.out;
  }
  EXPECT_TRUE(contains(run_drape({"--help"}).out, "drape run statue.yaml"));
}

TEST(CommandLine, UsageErrorsExitWith64) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{},
                                             {"drpae"},
                                             {"run"},
                                             {"run", "x.yaml", "--form", "mesh"},
                                             {"run", "x.yaml", "--progress=loud"},
                                             {"--threads", "-1", "status"}}) {
    const Outcome outcome = run_drape(arguments);
    EXPECT_EQ(outcome.exit_code, 64) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "drape: ")) << outcome.err;
  }
}

TEST(CommandLine, MakeKeepsAConfigurationThatWasEdited) {
  const ScratchFolder folder;
  write_file(folder / "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  const std::vector<std::string> command = {"make", "m.obj", "-o", "all"};
  EXPECT_EQ(run_drape(command, folder.path()).exit_code, 0);
  EXPECT_TRUE(fs::exists(folder / "all/model/model.glb"));
  EXPECT_EQ(run_drape(command, folder.path()).exit_code, 0);  // the same again
  const std::string edited = read_file(folder / "all/drape.yaml") + "fill: {base: leave}\n";
  write_file(folder / "all/drape.yaml", edited);
  const Outcome refused = run_drape(command, folder.path());
  EXPECT_EQ(refused.exit_code, 64) << refused.err;
  EXPECT_TRUE(contains(refused.err, "drape run ")) << refused.err;
  EXPECT_EQ(read_file(folder / "all/drape.yaml"), edited);
  fs::remove(folder / "all/model/model.glb");
  EXPECT_EQ(run_drape({"run", "all/drape.yaml"}, folder.path()).exit_code, 0);
  EXPECT_TRUE(fs::exists(folder / "all/model/model.glb"));
}

TEST(CommandLine, AlignFindsTheCameraOfOnePhoto) {
  const ScratchFolder folder;
  const std::string mesh = source("sample_scans/teapot/truth_mesh.ply").string();
  const std::string photo = source("sample_scans/teapot/photos/000.jpg").string();
  const auto align = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"-q", "align", mesh, photo, "-o", (folder / "found").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_drape(arguments, folder.path());
  };
  const Outcome found = align({"--evidence", "colour", "--box", "200,100,900,800"});
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_TRUE(contains(found.out, "by its colour")) << found.out;
  for (const char* name : {"found/cameras.json", "found/overlay.png", "found/stencil.png"})
    EXPECT_TRUE(fs::exists(folder / name)) << name;
  EXPECT_TRUE(contains(read_file(folder / "found/cameras.json"), "\"evidence\": \"colour\""));
  EXPECT_EQ(align({"--box", "5000,100,30,30"}).exit_code, 64);
  EXPECT_EQ(align({"--box", "1,2,3"}).exit_code, 64);
  EXPECT_EQ(align({"--evidence", "tea"}).exit_code, 64);
  EXPECT_EQ(align({"--mask", mesh}).exit_code, 65);
}

TEST(CommandLine, RelightDrawsAModelUnderANewLight) {
  const ScratchFolder folder;
  const std::string mesh = source("sample_scans/teapot/truth_mesh.ply").string();
  const auto relight = [&](const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"relight", mesh, "--size", "120", "-o", (folder / name).string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_drape(arguments, folder.path());
  };
  ASSERT_EQ(relight("left.png", {"--azimuth", "-70"}).exit_code, 0);
  ASSERT_EQ(relight("right.png", {"--azimuth", "70"}).exit_code, 0);
  const Image8 left = io::read_photo(folder / "left.png").rgb;
  const Image8 right = io::read_photo(folder / "right.png").rgb;
  const auto bright = [](const Image8& picture, int from, int to) {
    double sum = 0;
    for (int y = 0; y < picture.height(); ++y)
      for (int x = from; x < to; ++x) sum += picture.at(x, y);
    return sum;
  };
  EXPECT_GT(bright(left, 0, 60) - bright(left, 60, 120), bright(right, 0, 60) - bright(right, 60, 120));
  EXPECT_EQ(relight("x.png", {"--elevation", "100"}).exit_code, 64);
  EXPECT_EQ(relight("x.png", {"--up", "w"}).exit_code, 64);
}

TEST(CommandLine, NewWritesAConfigurationThatIsValid) {
  const ScratchFolder folder;
  fs::create_directories(folder / "scans");
  for (const char* name : {"000.ply", "001.ply"})
    fs::copy_file(source("sample_scans/teapot/scans") / name, folder / (std::string("scans/") + name));
  fs::copy_file(source("sample_scans/teapot/photos/000.jpg"), folder / "front.jpg");
  const std::vector<std::string> command = {"new", "scans/000.ply", "scans/001.ply", "--photo", "front.jpg",
                                            "-o",  "mine.yaml"};
  const Outcome made = run_drape(command, folder.path());
  EXPECT_EQ(made.exit_code, 0) << made.err;
  const std::string yaml = read_file(folder / "mine.yaml");
  EXPECT_TRUE(contains(yaml, "scans/001.ply")) << yaml;
  EXPECT_TRUE(contains(yaml, "image: \"front.jpg\"")) << yaml;
  const Outcome valid = run_drape({"validate", "mine.yaml"}, folder.path());
  EXPECT_EQ(valid.exit_code, 0) << valid.err;
  EXPECT_TRUE(contains(valid.out, "ingest, register, mesh, fill, segment, align, texture, export"))
      << valid.out;
  EXPECT_EQ(run_drape(command, folder.path()).exit_code, 64);  // it is there already
}

TEST(CommandLine, NewTellsAMeshFromScans) {
  const ScratchFolder folder;
  write_file(folder / "box.off",
             "OFF\n4 4 0\n0 0 0\n100 0 0\n0 100 0\n0 0 100\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
  EXPECT_EQ(run_drape({"new", "box.off", "-o", "c.yaml"}, folder.path()).exit_code, 0);
  EXPECT_TRUE(contains(read_file(folder / "c.yaml"), "mesh: \"box.off\""));
  EXPECT_TRUE(contains(read_file(folder / "c.yaml"), "units: mm"));
  const Outcome valid = run_drape({"validate", "c.yaml"}, folder.path());
  EXPECT_TRUE(contains(valid.out, "stages    fill, export")) << valid.out << valid.err;
}

TEST(CommandLine, InfoSaysHowSoundAMeshIs) {
  const ScratchFolder folder;
  write_file(folder / "open.off",
             "OFF\n4 3 0\n0 0 0\n100 0 0\n0 100 0\n0 0 100\n3 0 2 1\n3 0 1 3\n3 1 2 3\n");
  const Outcome open = run_drape({"info", "open.off"}, folder.path());
  EXPECT_EQ(open.exit_code, 0) << open.err;
  for (const char* words :
       {"boundary loops           1\n", "boundary edges           3\n", "manifold                 yes",
        "genus                    0\n", "not closed", "self-intersections       0"})
    EXPECT_TRUE(contains(open.out, words)) << words << open.out;
  write_file(folder / "closed.off",
             "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
  EXPECT_TRUE(
      contains(run_drape({"info", "closed.off"}, folder.path()).out, "volume                   0.166667\n"));
  write_file(folder / "bad.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
  write_file(folder / "empty.ply", "");
  EXPECT_TRUE(contains(run_drape({"info", "empty.ply"}, folder.path()).err, "empty.ply: is empty"));
  const Outcome bad = run_drape({"info", "bad.off"}, folder.path());
  EXPECT_EQ(bad.exit_code, 65);
  EXPECT_TRUE(contains(bad.err, "bad.off")) << bad.err;
}

TEST(CommandLine, InfoOfALargeScanReadsAPartOfIt) {
  const ScratchFolder folder;
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1200000\nproperty float x\nproperty float "
      "y\nproperty float z\nend_header\n";
  const std::size_t header = bytes.size();
  bytes.resize(header + 12UL * 1'200'000);
  for (int i = 0; i < 1'200'000; ++i) {
    const std::array<float, 3> p{0.5F * static_cast<float>(i % 1000), static_cast<float>(i / 1000), 0};
    std::memcpy(bytes.data() + header + 12UL * static_cast<std::size_t>(i), p.data(), 12);
  }
  write_file(folder / "a.ply", bytes);
  const Outcome ordered = run_drape({"info", "a.ply"}, folder.path());
  EXPECT_EQ(ordered.exit_code, 0) << ordered.err;
  for (const char* words : {"points   1200000 (x y z)", "spacing  0.5, along", "of the sample"})
    EXPECT_TRUE(contains(ordered.out, words)) << words << ordered.out;
  for (std::uint64_t i = 0; i < 1'200'000; ++i) {  // each point to another place, by a full cycle
    const std::uint64_t j = i * 736'481 % 1'200'000;
    const std::array<float, 3> p{0.5F * static_cast<float>(j % 1000), static_cast<float>(j / 1000), 0};
    std::memcpy(bytes.data() + header + 12UL * i, p.data(), 12);
  }
  write_file(folder / "b.ply", bytes);
  EXPECT_TRUE(contains(run_drape({"info", "b.ply"}, folder.path()).out, "a sample cannot tell"));
}

TEST(CommandLine, ReferenceIsCurrentAndCheckNoticesIfNot) {
  EXPECT_EQ(run_drape({"reference", source("config/REFERENCE.md").string(), "--check"}).exit_code, 0)
      << "make it again: drape reference config/REFERENCE.md";
  const ScratchFolder folder;
  EXPECT_EQ(run_drape({"reference", (folder / "r.md").string(), "--check"}).exit_code, 65);
  EXPECT_EQ(run_drape({"reference", (folder / "r.md").string()}).exit_code, 0);
  EXPECT_EQ(read_file(folder / "r.md"), read_file(source("config/REFERENCE.md")));
}

TEST(CommandLine, EveryShippedConfigurationIsValid) {
  std::size_t count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(source("config"))) {
    if (entry.path().extension() != ".yaml") continue;
    ++count;
    const Outcome outcome = run_drape({"validate", entry.path().string()});
    EXPECT_EQ(outcome.exit_code, 0) << entry.path() << outcome.err;
  }
  EXPECT_GE(count, 6U);
}

}  // namespace
}  // namespace drape::test
