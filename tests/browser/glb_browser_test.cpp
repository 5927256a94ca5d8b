// GLB files of every kind that drape writes, drawn in a browser by three.js.
#include <gtest/gtest.h>

#include <array>
#include <set>

#include "browser.hpp"
#include "drape/base/files.hpp"
#include "drape/io/photo.hpp"
#include "drape/report/page.hpp"
#include "model_kinds.hpp"
#include "support.hpp"

namespace drape::test {
namespace {

std::size_t colors_in(const Image8& image) {
  std::set<std::array<std::uint8_t, 3>> colors;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      colors.insert({image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)});
  return colors.size();
}

TEST(GlbInABrowser, EveryKindIsDrawn) {
  if (const std::string why = Browser::missing(); !why.empty()) GTEST_SKIP() << why;
  const ScratchFolder folder;
  Browser browser;
  browser.resize(420, 360);  // drawing without a graphics card takes its time
  for (const ModelKind& kind : model_kinds()) {
    SCOPED_TRACE(kind.name);
    io::write_glb(folder / "x.glb", kind.model, Eigen::Affine3d::Identity(), {0, 0, 0}, kind.options);
    report::RunPage page;
    page.title = kind.name;
    page.view =
        report::ModelView{read_file(folder / "x.glb"),
                          R"({"photos":[],"metres_per_unit":1,"y_up_from_input":[1,0,0,0,1,0,0,0,1]})"};
    write_file(folder / (kind.name + ".html"), report::render_page(page));
    std::filesystem::remove(folder / "x.glb");
    browser.open(folder / (kind.name + ".html"));
    ASSERT_TRUE(browser.wait_for("document.documentElement.dataset.view"));
    EXPECT_EQ(browser.evaluate("return document.documentElement.dataset.view"), "drawn");
    write_file(folder / (kind.name + ".png"), browser.screenshot_png("#model-canvas"));
    EXPECT_GT(colors_in(io::read_photo(folder / (kind.name + ".png")).rgb), 100U);
    EXPECT_EQ(browser.console_errors(), std::vector<std::string>{});
  }
}

}  // namespace
}  // namespace drape::test
