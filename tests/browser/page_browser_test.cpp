// The report of a run in a browser: it draws, turns, fits the window, and what is put right there helps.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include "browser.hpp"
#include "drape/base/files.hpp"
#include "drape/io/photo.hpp"
#include "drape/io/records.hpp"
#include "drape/metrics/stencil_agreement.hpp"
#include "drape/pipeline/config.hpp"
#include "drape/pipeline/fixes.hpp"
#include "drape/stages/stage_table.hpp"
#include "program.hpp"
#include "support.hpp"

namespace drape::test {
namespace {

namespace fs = std::filesystem;

Image8 picture_of(Browser& browser, const std::string& selector) {
  const ScratchFolder scratch;
  write_file(scratch / "a.png", browser.screenshot_png(selector));
  return io::read_photo(scratch / "a.png").rgb;
}

std::size_t colors_in(const Image8& image) {
  std::set<std::array<std::uint8_t, 3>> colors;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      colors.insert({image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)});
  return colors.size();
}

double share_that_differs(const Image8& a, const Image8& b) {
  if (a.data().size() != b.data().size()) return 1;
  std::size_t differ = 0;
  for (std::size_t i = 0; i < a.data().size(); ++i) differ += std::abs(a.data()[i] - b.data()[i]) > 8 ? 1 : 0;
  return static_cast<double>(differ) / static_cast<double>(a.data().size());
}

void expect_no_sideways_scrolling(Browser& browser) {
  EXPECT_LE(browser.evaluate("return document.documentElement.scrollWidth - window.innerWidth").get<double>(),
            0);
}

TEST(ReportInABrowser, OfTheTeapot) {
  if (const std::string why = Browser::missing(); !why.empty()) GTEST_SKIP() << why;
  const ScratchFolder scratch;
  const Outcome run =
      run_drape({"run", source("config/teapot.yaml").string(), "--workspace",
                 (scratch / "workspace").string(), "--set", "output=" + (scratch / "model").string()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const fs::path page = scratch / "workspace/runs/teapot/report.html";
  EXPECT_LT(fs::file_size(page), 5'000'000U);

  Browser browser;
  browser.resize(1280, 900);
  // The quickest of a few: other programs may be at work here.
  double drawn_ms = 1e9;
  for (int i = 0; i < 4 && drawn_ms >= 3000; ++i) {
    browser.open(page);
    ASSERT_TRUE(browser.wait_for("document.documentElement.dataset.view"));
    EXPECT_EQ(browser.evaluate("return document.documentElement.dataset.view"), "drawn");
    drawn_ms = std::min(
        drawn_ms, browser.evaluate("return Number(document.documentElement.dataset.drawnMs)").get<double>());
  }
  EXPECT_LT(drawn_ms, 3000);
  const Image8 first = picture_of(browser, "#model-canvas");
  EXPECT_GT(colors_in(first), 1000U);
  expect_no_sideways_scrolling(browser);

  browser.drag("#model-canvas", {{0.3, 0.5}, {0.5, 0.5}, {0.7, 0.5}});
  const Image8 turned = picture_of(browser, "#model-canvas");
  EXPECT_GT(share_that_differs(first, turned), 0.03);
  browser.type("#model-canvas", "\uE012\uE012\uE013");  // arrow keys: left, left, up
  const Image8 by_keys = picture_of(browser, "#model-canvas");
  EXPECT_GT(share_that_differs(turned, by_keys), 0.01);
  browser.click("button[data-key=coverage]");
  EXPECT_GT(share_that_differs(by_keys, picture_of(browser, "#model-canvas")), 0.03);
  EXPECT_NE(browser.evaluate("return document.querySelector('.legend').innerText")
                .get<std::string>()
                .find("000.jpg"),
            std::string::npos);

  browser.resize(400, 800);
  browser.prefer("dark");
  browser.open(page);
  ASSERT_TRUE(browser.wait_for("document.documentElement.dataset.view"));
  expect_no_sideways_scrolling(browser);
  EXPECT_EQ(browser.evaluate("return document.querySelectorAll('img:not([alt])').length"), 0);
  EXPECT_EQ(browser.console_errors(), std::vector<std::string>{});
}

// A mesh and a photo, where the object was looked for in the wrong place.
class WrongBox {
 public:
  WrongBox() {
    write_file(config(),
               "input:\n  mesh: " + source("sample_scans/teapot/truth_mesh.ply").string() +
                   "\n  units: mm\n  photos:\n    - image: " +
                   source("sample_scans/teapot/photos/000.jpg").string() +
                   "\n      box_px: [0, 0, 200, 160]\nexport: {obj: false, ply: false, web_triangles: 4000}\n"
                   "fill: {simplify_triangles: 8000}\n");
  }
  [[nodiscard]] fs::path config() const { return scratch_ / "bad.yaml"; }
  [[nodiscard]] fs::path run_folder() const { return scratch_ / "drape-workspace/runs/bad"; }
  [[nodiscard]] Outcome run(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {"run", config().string(), "--progress=plain"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_drape(arguments);
  }

 private:
  ScratchFolder scratch_;
};

double stencil_error_percent(const fs::path& stencil) {
  const fs::path truth_file = source("sample_scans/teapot/photos/000_stencil.png");
  const io::ImageSize size = io::read_photo_size(truth_file);
  return 100 - metrics::stencil_overlap(io::read_stencil(truth_file, size.width, size.height),
                                        io::read_stencil(stencil, size.width, size.height))
                   .percent();
}

// The first photo's input after the fixes that are downloaded now.
pipeline::PhotoInput fixed_photo(Browser& browser, const fs::path& config, const std::string& download) {
  browser.click("#download-fixes");
  const std::vector<pipeline::ObjectFixes> fixes = pipeline::read_fixes(browser.downloaded(download));
  pipeline::ConfigNode root = pipeline::parse_yaml(read_file(config), config.string());
  pipeline::apply_fixes(root, fixes.at(0));
  const auto table = stages::stage_table();
  return pipeline::configure({"bad", config, "", root}, table, {}).input.photos.at(0);
}

// What the page offers, tool by tool: every fix that it writes is one that a run takes.
void expect_every_tool_writes_a_valid_fix(Browser& browser, const fs::path& config) {
  browser.click("#mend button[data-key=click]");
  browser.drag(".pad", {{0.5, 0.5}});
  browser.click("#mend button[data-key=strokes]");
  browser.drag(".pad", {{0.4, 0.5}, {0.5, 0.55}, {0.6, 0.5}});
  browser.click("#mend button[data-key=background]");
  browser.drag(".pad", {{0.1, 0.9}, {0.5, 0.95}, {0.9, 0.9}});
  browser.click("#mend button[data-key=points]");
  ASSERT_TRUE(browser.wait_for("document.querySelector('.pick')?.width > 100"));
  const std::array<std::array<double, 2>, 4> places{{{0.45, 0.45}, {0.55, 0.45}, {0.5, 0.56}, {0.46, 0.52}}};
  for (const auto& place : places) {
    browser.drag(".pick", {place});
    browser.drag(".pad", {place});
  }
  const pipeline::PhotoInput drawn = fixed_photo(browser, config, "fixes (1).yaml");
  EXPECT_TRUE(drawn.box_px.has_value());
  EXPECT_TRUE(drawn.click_px.has_value());
  EXPECT_EQ(drawn.strokes.size(), 2U);
  EXPECT_EQ(drawn.camera.points.size(), 4U);
  // Each of these takes the place of what says the same in another way.
  browser.click("#mend button[data-key=segments]");
  browser.drag(".pad", {{0.5, 0.5}});
  browser.click("#mend button[data-key=pose]");
  browser.drag("#mend .slider input", {{0.5, 0.5}, {0.6, 0.5}});
  const pipeline::PhotoInput chosen = fixed_photo(browser, config, "fixes (2).yaml");
  EXPECT_FALSE(chosen.segments.empty());
  EXPECT_TRUE(chosen.strokes.empty());
  EXPECT_TRUE(chosen.camera.initial.has_value());
  EXPECT_TRUE(chosen.camera.points.empty());
}

TEST(ReportInABrowser, PutsABadObjectRight) {
  if (const std::string why = Browser::missing(); !why.empty()) GTEST_SKIP() << why;
  const WrongBox bad;
  ASSERT_EQ(bad.run().exit_code, 0);
  const fs::path stencil = bad.run_folder() / "2-segment/000/stencil.png";
  ASSERT_GT(stencil_error_percent(stencil), 20);

  Browser browser;
  browser.resize(1280, 900);
  browser.open(bad.run_folder() / "report.html");
  ASSERT_TRUE(browser.wait_for("document.querySelector('#mend button[data-key=box]')"));
  // Three actions: the tool, the box, the file.
  browser.click("#mend button[data-key=box]");
  browser.drag(".pad", {{0.15, 0.08}, {0.5, 0.5}, {0.92, 0.88}});
  browser.click("#download-fixes");
  const fs::path fixes = browser.downloaded("fixes.yaml");
  const Outcome mended = bad.run({"--fixes", fixes.string()});
  ASSERT_EQ(mended.exit_code, 0) << mended.err;
  EXPECT_EQ(stages_that_ran(mended), (std::vector<std::string>{"segment", "align", "texture", "export"}));
  EXPECT_LT(stencil_error_percent(stencil), 5);

  expect_every_tool_writes_a_valid_fix(browser, bad.config());
  EXPECT_EQ(browser.console_errors(), std::vector<std::string>{});
}

TEST(BatchInABrowser, CollectsTheFixesOfItsObjects) {
  if (const std::string why = Browser::missing(); !why.empty()) GTEST_SKIP() << why;
  const ScratchFolder scratch;
  const std::string mesh = source("sample_scans/teapot/truth_mesh.ply").string();
  const std::string photo = source("sample_scans/teapot/photos/000.jpg").string();
  write_file(scratch / "light.yaml",
             "export: {obj: false, ply: false, web_triangles: 4000}\nfill: {simplify_triangles: 8000}\n");
  write_file(scratch / "cans.yaml",
             "config: light.yaml\nobjects:\n  - {id: fine, mesh: " + mesh + ", units: mm, photos: [" + photo +
                 "]}\n  - {id: lost, mesh: " + mesh + ", units: mm, photos: [{image: " + photo +
                 ", box_px: [0, 0, 200, 160]}]}\n  - {id: none, mesh: no.ply}\n");
  EXPECT_EQ(run_drape({"batch", "run", (scratch / "cans.yaml").string()}).exit_code, 1);

  Browser browser;
  browser.resize(1280, 900);
  browser.open(scratch / "drape-workspace/batches/cans/report.html");
  const auto order = [&] {
    return browser.evaluate(
        "return [...document.querySelectorAll('tbody tr')].map((row) => row.dataset.object)");
  };
  EXPECT_EQ(order(), (nlohmann::json{"none", "lost", "fine"}));
  browser.click("th:nth-child(2) button");
  EXPECT_EQ(order(), (nlohmann::json{"fine", "lost", "none"}));
  expect_no_sideways_scrolling(browser);

  browser.follow("tr[data-object=lost] a");
  ASSERT_TRUE(browser.wait_for("document.querySelector('#mend button[data-key=box]')"));
  browser.click("#mend button[data-key=box]");
  browser.drag(".pad", {{0.15, 0.08}, {0.5, 0.5}, {0.92, 0.88}});
  browser.back_to_the_first_window();
  ASSERT_TRUE(browser.wait_for("document.querySelector('tr.mended')"));
  browser.click("#download-fixes");
  const Outcome applied = run_drape(
      {"batch", "apply", browser.downloaded("fixes.yaml").string(), (scratch / "cans.yaml").string()});
  EXPECT_EQ(applied.exit_code, 1) << applied.err;  // the one without a mesh is still there
  EXPECT_EQ(applied.err.find("fine"), std::string::npos) << applied.err;
  EXPECT_LT(stencil_error_percent(scratch / "drape-workspace/runs/cans/lost/2-segment/000/stencil.png"), 5);
  browser.resize(400, 800);
  browser.open(scratch / "drape-workspace/batches/cans/report.html");
  expect_no_sideways_scrolling(browser);
  EXPECT_EQ(browser.console_errors(), std::vector<std::string>{});
}

}  // namespace
}  // namespace drape::test
