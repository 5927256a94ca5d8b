#include "drape/pipeline/config.hpp"

#include <gtest/gtest.h>

#include "drape/pipeline/reference.hpp"
#include "toy_stages.hpp"

namespace drape::pipeline {
namespace {

std::string problem(const test::ToyProject& project, ErrorCode code = ErrorCode::config,
                    const std::vector<std::string>& sets = {}) {
  return test::error_message(code, [&] { (void)project.load(sets); });
}

TEST(Config, DefaultsAndPaths) {
  const test::ToyProject project;
  const Config config = project.load();
  EXPECT_EQ(config.name, "toy");
  EXPECT_EQ(config.workspace, project / "drape-workspace");
  EXPECT_EQ(config.output, project / "toy-model");
  EXPECT_EQ(config.input.mesh, project / "text.txt");
  EXPECT_EQ(config.seed, 1U);
  EXPECT_EQ(config.stages.size(), 4U);
}

TEST(Config, EveryProblemIsReportedWithItsPlace) {
  const test::ToyProject project;
  project.write_config(
      "read:\n  wrods: 3\n  words: -1\nchagne:\n  capitals: true\nchange: {capitals: maybe}\n");
  const std::string message = problem(project);
  EXPECT_NE(message.find("toy.yaml:4:3: read.wrods: no such key; did you mean words?"), std::string::npos)
      << message;
  EXPECT_NE(message.find(
                "toy.yaml:5:10: read.words = -1: is -1; must be within 0 and 1000 (how many words are kept)"),
            std::string::npos)
      << message;
  EXPECT_NE(message.find("toy.yaml:6:1: chagne: no such key; did you mean change?"), std::string::npos)
      << message;
  EXPECT_NE(message.find("change.capitals = maybe: is 'maybe'; must be true or false"), std::string::npos)
      << message;
}

TEST(Config, MissingFilesAreInputErrors) {
  const test::ToyProject project;
  write_file(project / "toy.yaml", "input:\n  mesh: none.ply\n");
  EXPECT_NE(problem(project, ErrorCode::input).find("toy.yaml:2:9: input.mesh = none.ply: no such file"),
            std::string::npos);
  write_file(project / "toy.yaml", "input:\n  scans: ['*.scan']\n");
  EXPECT_NE(problem(project, ErrorCode::input).find("no file matches"), std::string::npos);
  EXPECT_NE(test::error_message(ErrorCode::input,
                                [&] { (void)load_config(project / "no.yaml", test::toy_stages(), {}); })
                .find("no.yaml: no such file"),
            std::string::npos);
}

TEST(Config, WhatIsKnownOfAScan) {
  const test::ToyProject project;
  for (const char* name : {"b.scan", "a.scan", "c.png"}) write_file(project / name, "x");
  write_file(project / "toy.yaml",
             "input:\n  units: m\n  columns: [x, y, '-', z]\n  max_points_per_scan: 1000\n"
             "  depth: {focal_px: 525, values_per_unit: 1000, depth: range}\n  scans:\n    - c.png\n"
             "    - {file: '?.scan', units: mm, pose: [1, 2, 3, 0.5, 0.5, 0.5, 0.5]}\n");
  const Input input = project.load().input;
  ASSERT_EQ(input.scans.size(), 3U);
  EXPECT_FALSE(input.scans[0].world_from_scan);
  EXPECT_EQ(input.scans[2].file.filename(), "b.scan");
  EXPECT_EQ(input.scans[2].metres_per_unit, 0.001);
  // A third of a turn about (1, 1, 1) takes x to y.
  EXPECT_EQ(*input.scans[2].world_from_scan,
            (std::array<double, 16>{0, 0, 1, 1, 1, 0, 0, 2, 0, 1, 0, 3, 0, 0, 0, 1}));
  EXPECT_EQ(input.columns, (std::vector<std::string>{"x", "y", "-", "z"}));
  EXPECT_EQ(input.max_points_per_scan, 1000);
  EXPECT_TRUE(input.depth->along_ray);
  EXPECT_EQ(input.depth->focal_px[1], 525);
}

TEST(Config, WhatIsWrongWithAScan) {
  const test::ToyProject project;
  write_file(project / "a.scan", "x");
  const auto message = [&](const std::string& scan) {
    write_file(project / "toy.yaml", "input:\n  scans:\n    - " + scan + "\n");
    return problem(project);
  };
  EXPECT_NE(message("{file: a.scan, units: mm}").find("needs input.units as well"), std::string::npos);
  EXPECT_NE(message("{file: a.scan, pose: [1, 2, 3, 0, 0, 0, 0]}").find("is no rigid motion"),
            std::string::npos);
  EXPECT_NE(
      message("{file: a.scan, transform: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0]}").find("is no rigid motion"),
      std::string::npos);
  EXPECT_NE(message("{fiel: a.scan}").find("did you mean file?"), std::string::npos);
}

TEST(Config, InputSection) {
  const test::ToyProject project;
  for (const char* name : {"b.scan", "a.scan", "c.jpg", "m.png"}) write_file(project / name, "x");
  write_file(project / "toy.yaml",
             "input:\n  scans: ['*.scan']\n  units: mm\n  up: y\n  photos:\n"
             "    - {image: c.jpg, mask: m.png, box_px: [1, 2, 30, 40], click_px: [5, 6],\n"
             "       camera: {focal_px: 900, distortion: [0.1, 0, 0, 0]}}\n"
             "    - c.jpg\n");
  const Config config = project.load();
  ASSERT_EQ(config.input.scans.size(), 2U);
  EXPECT_EQ(config.input.scans[0].file.filename(), "a.scan");
  EXPECT_EQ(config.input.units, Units::millimetres);
  EXPECT_EQ(config.input.up, 'y');
  ASSERT_EQ(config.input.photos.size(), 2U);
  EXPECT_EQ(config.input.photos[0].mask.filename(), "m.png");
  EXPECT_EQ((*config.input.photos[0].box_px)[3], 40);
  EXPECT_EQ(config.input.photos[0].camera.focal_px, 900);
  EXPECT_EQ(config.input.photos[1].image.filename(), "c.jpg");
}

TEST(Config, WhatAPersonShowedInAPhoto) {
  const test::ToyProject project;
  for (const char* name : {"a.scan", "c.jpg"}) write_file(project / name, "x");
  const auto photo = [&](const std::string& keys) {
    write_file(project / "toy.yaml",
               "input:\n  scans: a.scan\n  photos:\n    - {image: c.jpg, " + keys + "}\n");
    return project.load().input.photos.at(0);
  };
  const PhotoInput drawn = photo(
      "segments: [3, 1], strokes: [{is: object, width_px: 8, points_px: [1, 2, 3, 4]}, {is: background, "
      "points_px: [5, "
      "6]}]");
  EXPECT_EQ(drawn.segments, (std::vector<double>{3, 1}));
  ASSERT_EQ(drawn.strokes.size(), 2U);
  EXPECT_TRUE(drawn.strokes[0].object);
  EXPECT_EQ(drawn.strokes[0].width_px, 8);
  EXPECT_EQ(drawn.strokes[0].points_px[1], (std::array<double, 2>{3, 4}));
  EXPECT_FALSE(drawn.strokes[1].object);
  EXPECT_EQ(photo("camera: {initial: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]}").camera.initial->at(11), 12);
  const PhotoInput paired =
      photo("camera: {points: [1, 2, 3, 4, 5, 1, 2, 3, 4, 5, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10]}");
  ASSERT_EQ(paired.camera.points.size(), 4U);
  EXPECT_EQ(paired.camera.points[3][4], 10);

  const auto message = [&](const std::string& keys) {
    write_file(project / "toy.yaml",
               "input:\n  scans: a.scan\n  photos:\n    - {image: c.jpg, " + keys + "}\n");
    return problem(project);
  };
  EXPECT_NE(message("strokes: [{is: thing, points_px: [1, 2]}]").find("object or background"),
            std::string::npos);
  EXPECT_NE(message("strokes: [{is: object, points_px: [1, 2, 3]}]").find("pairs of x and y"),
            std::string::npos);
  EXPECT_NE(message("strokes: [{is: object}]").find("has no points_px"), std::string::npos);
  EXPECT_NE(message("strokes: [{is: object, width_px: 0, points_px: [1, 2]}]").find("more than 0"),
            std::string::npos);
  EXPECT_NE(message("camera: {points: [1, 2, 3, 4, 5]}").find("20 to 5000"), std::string::npos);
  EXPECT_NE(message("camera: {initial: [1, 2]}").find("must have 12"), std::string::npos);
  EXPECT_NE(
      message(
          "camera: {initial: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12], points: [1, 2, 3, 4, 5, 1, 2, 3, 4, 5, "
          "1, 2, 3, 4, 5, 6, 7, 8, 9, 10]}")
          .find("leave one of them out"),
      std::string::npos);
}

TEST(Config, WrongInputSections) {
  const test::ToyProject project;
  const auto message = [&](const std::string& input) {
    write_file(project / "toy.yaml", "input:\n" + input);
    return problem(project);
  };
  EXPECT_NE(message("  units: mm\n").find("neither scans nor a mesh"), std::string::npos);
  EXPECT_NE(message("  mesh: text.txt\n  scans: text.txt\n").find("both scans and a mesh"),
            std::string::npos);
  EXPECT_NE(message("  mesh: text.txt\n  unit: mm\n").find("did you mean units?"), std::string::npos);
  EXPECT_NE(message("  mesh: text.txt\n  units: furlong\n").find("must be one of"), std::string::npos);
  EXPECT_NE(message("  mesh: text.txt\n  photos: {image: a}\n").find("must be a list"), std::string::npos);
  EXPECT_NE(message("  mesh: text.txt\n  photos: [{box_px: [1, 2, 3, 4]}]\n").find("has no image"),
            std::string::npos);
  EXPECT_NE(message("  mesh: text.txt\n  photos: [{image: text.txt, box_px: [1, 2, 3]}]\n")
                .find("has 3 numbers; must have 4"),
            std::string::npos);
  EXPECT_NE(message("  mesh: text.txt\n  photos: [{image: text.txt, box_px: [1, 2, 0, 3]}]\n")
                .find("must be more than 0"),
            std::string::npos);
  EXPECT_NE(message("  mesh: text.txt\n  photos: [{image: text.txt, camera: {focal: 3}}]\n")
                .find("did you mean focal_px?"),
            std::string::npos);
  write_file(project / "toy.yaml", "- a\n- b\n");
  EXPECT_NE(problem(project).find("is no configuration"), std::string::npos);
}

TEST(Config, SetOverridesTheFile) {
  const test::ToyProject project;
  project.write_config("read: {words: 5}\n");
  const Config config = project.load({"read.words=2", "seed=9"});
  EXPECT_EQ(std::get<std::int64_t>(config.stages[0].instance.options[0].get()), 2);
  EXPECT_EQ(config.seed, 9U);
  EXPECT_NE(
      problem(project, ErrorCode::config, {"read.words=many"}).find("--set read.words: read.words = many"),
      std::string::npos);
  EXPECT_NE(problem(project, ErrorCode::config, {"read.words"}).find("must be key=value"), std::string::npos);
  EXPECT_NE(problem(project, ErrorCode::config, {"seed=-1"}).find("whole number"), std::string::npos);
}

TEST(Reference, NamesEveryStageAndOption) {
  const std::string page = reference_page(test::toy_stages());
  EXPECT_NE(page.find("| `words` | `100` | 0 to 1000, whole | how many words are kept |"), std::string::npos)
      << page;
  EXPECT_NE(page.find("## `publish`"), std::string::npos);
  EXPECT_EQ(page.back(), '\n');
}

}  // namespace
}  // namespace drape::pipeline
