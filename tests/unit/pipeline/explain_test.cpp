#include <gtest/gtest.h>

#include "drape/pipeline/engine.hpp"
#include "toy_stages.hpp"

namespace drape::pipeline {
namespace {

std::string forecast_text(const test::ToyProject& project, const std::vector<std::string>& sets = {}) {
  std::string text;
  for (const Forecast& forecast : explain(project.load(sets), "")) {
    text += forecast.stage + ":";
    text += forecast.state == Forecast::State::up_to_date  ? "ok"
            : forecast.state == Forecast::State::would_run ? "run"
                                                           : "may";
    for (const std::string& reason : forecast.reasons) text += "[" + reason + "]";
    text += " ";
  }
  return text;
}

TEST(Explain, NamesWhatChanged) {
  test::ToyProject project;
  EXPECT_NE(forecast_text(project).find("read:run[it has no result in run toy]"), std::string::npos);
  project.run();
  EXPECT_EQ(forecast_text(project), "read:ok change:ok count:ok publish:ok ");
  EXPECT_EQ(forecast_text(project, {"change.capitals=false"}),
            "read:ok change:run[option change.capitals: true -> false] count:ok publish:may[reads change, "
            "which would run] ");
  EXPECT_EQ(forecast_text(project, {"seed=3"}).substr(0, 26), "read:run[seed: 1 -> 3] cha");
  project.write_text("other words");
  EXPECT_NE(forecast_text(project).find(
                "read:run[input.mesh (text.txt) has other contents] change:may[reads read, which would run]"),
            std::string::npos)
      << forecast_text(project);
}

TEST(Explain, NoticesMissingResultsAndChangesNothing) {
  test::ToyProject project;
  project.run();
  std::filesystem::remove(project / "drape-workspace/runs/toy/3-count/count.txt");
  EXPECT_NE(forecast_text(project).find("count:run[its result is gone or damaged]"), std::string::npos);
  EXPECT_EQ(project.run(), "count");
}

TEST(Explain, AgreesWithWhatRuns) {
  test::ToyProject project;
  project.run();
  for (const std::string set : {"read.words=2", "change.capitals=false", "input.units=m", "seed=5"}) {
    std::string expected;
    for (const Forecast& forecast : explain(project.load({set}), ""))
      if (forecast.state == Forecast::State::would_run) expected += forecast.stage + " ";
    const std::string ran = project.run({set}) + " ";
    EXPECT_EQ(ran.substr(0, expected.size()), expected) << set;
    project.run();
  }
}

}  // namespace
}  // namespace drape::pipeline
