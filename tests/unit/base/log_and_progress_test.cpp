#include <gtest/gtest.h>

#include <atomic>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/log.hpp"
#include "drape/base/progress.hpp"
#include "support.hpp"

namespace drape {
namespace {

TEST(Log, WarningsAreCapturedAndWrittenToTheFile) {
  const test::ScratchFolder folder;
  {
    const log::FileSink file(folder / "run.log");
    const log::WarningCapture capture;
    log::info("reading {}", 3);
    log::warn("units guessed: {}", "mm");
    EXPECT_EQ(capture.warnings(), std::vector<std::string>{"units guessed: mm"});
  }
  log::info("after");
  const std::string text = read_file(folder / "run.log");
  EXPECT_NE(text.find("reading 3"), std::string::npos);
  EXPECT_NE(text.find("units guessed: mm"), std::string::npos);
  EXPECT_EQ(text.find("after"), std::string::npos);
}

TEST(Progress, PartsMapIntoTheWhole) {
  double last = -1;
  const Progress whole([&](double fraction, std::string_view) { last = fraction; }, nullptr);
  whole.part(0.5, 1.0).part(0.0, 0.5).update(0.5);
  EXPECT_DOUBLE_EQ(last, 0.625);
  whole.update(7);
  EXPECT_DOUBLE_EQ(last, 1.0);
}

TEST(Progress, StopsWhenAsked) {
  std::atomic<bool> stop{false};
  const Progress progress({}, &stop);
  EXPECT_NO_THROW(progress.update(0.1));
  stop = true;
  EXPECT_TRUE(progress.part(0, 0.5).stop_requested());
  EXPECT_THROW(progress.part(0, 0.5).update(0.2), Interrupted);
  EXPECT_NO_THROW(Progress().update(1));
}

}  // namespace
}  // namespace drape
